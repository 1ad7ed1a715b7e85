// fuzz_grid.cpp: maps: DX, cube, VTI, as they are or packed by gzip.
#include "fuzz/fuzz_file.h"
#include "io/grids/read_grid.h"
#include "io/grids/read_vti.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::Grid grid = espdiff::read_grid(path);
    // What is accepted must hold together.
    if (grid.values.size() != grid.lattice.n_points()) std::abort();
    for (const float value : grid.values) {
      if (!(value - value == 0)) std::abort();
    }
  });
}
