// hdf5_module.cpp: the module with HDF5: files of ensembles.
#include "cli/modules/hdf5_functions.h"

#include "base/version.h"

extern "C" __attribute__((visibility("default"))) const void* espdiff_module() {
  static constexpr espdiff::Hdf5Functions kFunctions = {espdiff::kVersion, &espdiff::write_by_hdf5};
  return &kFunctions;
}
