// fuzz_assembly.cpp: biological assemblies of PDB (REMARK 350) and mmCIF files.
#include <cmath>

#include "base/types.h"
#include "fuzz/fuzz_file.h"
#include "io/structures/structure_file.h"

namespace {

void read_assembly(const espdiff::StructureFile& file, const char* name) {
  const espdiff::Molecule molecule = file.read({1, true, true, name});
  if (molecule.size() == 0 || molecule.atoms.size() != molecule.size()) std::abort();
  for (const espdiff::Atom& atom : molecule.atoms) {
    if (atom.residue >= molecule.residues.size()) std::abort();
  }
  for (const espdiff::Vec3d& p : molecule.positions) {
    if (!std::isfinite(p.x + p.y + p.z)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* const name : {"1", "A"}) {
    espdiff_fuzz::read_as_file(espdiff_fuzz::bytes_of(data, size),
                               [&](const std::string& path) { read_assembly(espdiff::StructureFile(path), name); });
  }
  return 0;
}
