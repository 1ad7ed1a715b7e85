// fuzz_vtp.cpp: mapped surfaces (VTP), as render and view read them.
#include "fuzz/fuzz_file.h"
#include "io/vtk/read_vtp.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::VtpContent surface = espdiff::read_vtp(path);
    for (const espdiff::Triangle& triangle : surface.triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= surface.positions.size()) std::abort();
      }
    }
    for (const espdiff::VtpNumbers& array : surface.point_arrays) {
      if (array.n_tuples() != surface.positions.size()) std::abort();
    }
  });
}
