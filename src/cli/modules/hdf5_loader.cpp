// hdf5_loader.cpp: the program's side of its module with HDF5: loads it when the first file of an ensemble is made.
#include "base/error.h"
#include "cli/modules/hdf5_functions.h"
#include "cli/modules/load_module.h"

namespace espdiff {
namespace {

const Hdf5Functions* hdf5_functions(std::string& problem) {
  const ProgramModule module = {"espdiff_hdf5.so", "HDF5, for files of ensembles",
                                "the HDF5 library that it was built with (Debian: libhdf5, or apt install -f)"};
  return static_cast<const Hdf5Functions*>(load_module(module, problem));
}

}  // namespace

std::vector<WrittenDataset> write_by_hdf5(const std::string& place, const std::string& path, const EnsembleHead& head) {
  std::string problem;
  const Hdf5Functions* const functions = hdf5_functions(problem);
  if (functions == nullptr) throw DeviceError(problem);
  return functions->write_by_hdf5(place, path, head);
}

std::string hdf5_problem() {
  std::string problem;
  hdf5_functions(problem);
  return problem;
}

}  // namespace espdiff
