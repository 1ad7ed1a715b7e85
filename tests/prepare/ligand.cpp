// Ligands: hydrogens of a MOL2 file at the residues that it describes, and how many of them are taken.
#include "prepare/charges/ligand.h"

#include <doctest/doctest.h>

#include "io/molecules/molecule_builder.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;

namespace {

const Vec3d kHeavy[] = {{0, 0, 0}, {1.5, 0, 0}, {0, 1.5, 0}};

/// Three heavy atoms and hydrogens.
Mol2File ligand(std::size_t n_hydrogens) {
  Mol2File file;
  file.path = "a.mol2";
  for (int i = 0; i < 3; ++i) file.atoms.push_back({"C" + std::to_string(i), "C", kHeavy[i]});
  for (std::size_t h = 0; h < n_hydrogens; ++h) file.atoms.push_back({"H", "H", {0, 0, 1}});
  return file;
}

/// The heavy atoms alone, each residue a step along x from the one before.
Molecule residues(int n) {
  Molecule molecule;
  molecule.name = "m.pdb";
  for (int r = 0; r < n; ++r) {
    molecule.residues.push_back({"LIG", "A", r + 1, ' '});
    for (int i = 0; i < 3; ++i) {
      molecule.atoms.push_back({"C" + std::to_string(i), "C", r, true});
      molecule.positions.push_back(kHeavy[i] + Vec3d{10.0 * r, 0, 0});
      molecule.radii.push_back(1.7F);
    }
  }
  return molecule;
}

}  // namespace

TEST_CASE("add_ligand_hydrogens: a file's hydrogens go to each residue that it describes") {
  const Molecule molecule = residues(2);
  const std::vector<Mol2File> files = {ligand(1)};
  const std::vector<std::int32_t> which = ligands_of_residues(molecule, files);
  CHECK(which == std::vector<std::int32_t>{0, 0});
  const Molecule complete = add_ligand_hydrogens(molecule, files, which);
  REQUIRE(complete.size() == 8);
  CHECK(complete.positions[6].z == doctest::Approx(1));
  CHECK(complete.positions[7].x == doctest::Approx(10));
}

TEST_CASE("add_ligand_hydrogens: more atoms than a molecule has are refused as they come") {
  const Molecule molecule = residues(6);
  const std::vector<Mol2File> files = {ligand(1'000'000)};
  CHECK(message_of([&] { add_ligand_hydrogens(molecule, files, ligands_of_residues(molecule, files)); }) ==
        "a.mol2: with its hydrogens m.pdb has more than 5000000 atoms, which is the most that are read");
}
