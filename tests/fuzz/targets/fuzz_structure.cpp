// fuzz_structure.cpp: structures: PQR, PDB, mmCIF, each as it is or packed by gzip.
#include "fuzz/fuzz_file.h"
#include "io/structures/structure_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::StructureFile file(path);
    for (int model = 1; model <= file.n_models() && model <= 3; ++model) file.read({model, true, true});
    file.unit_cell(1);
  });
}
