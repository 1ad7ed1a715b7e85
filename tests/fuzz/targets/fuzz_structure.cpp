// fuzz_structure.cpp: structures: PQR, PDB, mmCIF, GRO, MOL2, Amber's coordinates, each as it is or packed by gzip.
#include "fuzz/fuzz_file.h"
#include "io/structures/structure_file.h"

namespace {

/// So many atoms, which Amber's coordinates do not name.
espdiff::Molecule nameless_atoms(std::size_t n) {
  espdiff::Molecule molecule;
  molecule.name = "a.prmtop";
  molecule.residues.push_back({"LIG", "", 1, ' '});
  molecule.atoms.assign(n, {"C", "C", 0, false});
  molecule.positions.resize(n);
  molecule.radii.assign(n, 1.7F);
  return molecule;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::StructureFile file(path);
    for (int model = 1; model <= file.n_models() && model <= 3; ++model) {
      const espdiff::StructureOptions options{model, true, true, {}};
      if (file.needs_atoms()) file.read_with(nameless_atoms(file.n_atoms(1)), options);
      if (!file.needs_atoms()) file.read(options);
    }
    file.unit_cell(1);
  });
}
