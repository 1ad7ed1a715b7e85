// fuzz_mol2.cpp: ligands (MOL2).
#include <cmath>

#include "fuzz/fuzz_file.h"
#include "io/structures/read_mol2.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size), [](const std::string& path) {
    const espdiff::Mol2File ligand = espdiff::read_mol2(path);
    if (ligand.atoms.empty()) std::abort();
    for (const espdiff::Mol2Atom& atom : ligand.atoms) {
      for (const double x : {atom.position.x, atom.position.y, atom.position.z}) {
        if (!(std::fabs(x) <= 1e6)) std::abort();
      }
    }
    for (const espdiff::Mol2Bond& bond : espdiff::read_mol2_bonds(ligand)) {
      if (bond.a >= ligand.atoms.size() || bond.b >= ligand.atoms.size() || bond.a == bond.b) std::abort();
    }
  });
}
