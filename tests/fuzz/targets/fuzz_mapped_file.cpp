// fuzz_mapped_file.cpp: OUT.vtp of a comparison, as `espdiff verify` reads it.
#include "fuzz/fuzz_file.h"
#include "verify/mapped_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::MappedFile mapped(path);
    const std::size_t n = mapped.positions.size(), n_triangles = mapped.triangles.size();
    if (mapped.source_positions.size() != n || mapped.residue.size() != n || mapped.is_valid.size() != n_triangles)
      std::abort();
    mapped.weights(mapped.with_potentials(mapped.is_valid));
    mapped.matched();
  });
}
