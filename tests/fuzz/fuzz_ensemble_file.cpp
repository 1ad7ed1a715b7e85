// fuzz_ensemble_file.cpp: an ensemble's HDF5 file.
#include "ensemble/ensemble_file.h"
#include "fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::EnsembleFile file(path, false);
    for (std::size_t f = 0; f < file.plan().n_frames(); ++f) {
      if (file.has(f)) file.numbers(f);
    }
  });
}
