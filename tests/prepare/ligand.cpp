// ligand.cpp: hydrogens of MOL2 files at the residues that they describe, and bonds of definitions.
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

/// A chain of atoms 1.4 A apart along a zigzag, named by their elements and numbers from 1.
Molecule zigzag(const std::string& elements) {
  Molecule molecule;
  molecule.residues = {{"FOO", "A", 1, ' '}};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string element(1, elements[i]);
    molecule.atoms.push_back({element + std::to_string(i + 1), element, 0, true});
    molecule.positions.push_back({1.2 * static_cast<double>(i), i % 2 == 0 ? 0 : 0.7, 0});
  }
  return molecule;
}

/// Its definition; orders of the bonds along it.
Component chain(const std::string& elements, const std::vector<int>& orders) {
  Component component{"in/FOO.cif", "FOO", {}, {}};
  for (const Atom& atom : zigzag(elements).atoms) component.atoms.push_back({atom.name, 0});
  for (std::size_t i = 0; i < orders.size(); ++i) component.bonds.push_back({i, i + 1, orders[i]});
  return component;
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

TEST_CASE("bonds_by_definition: by the names of residue and atoms, in their order, where the lengths are of bonds") {
  Molecule molecule = zigzag("CCO");
  const std::vector<Component> given{chain("CCO", {1, 2})};
  const std::optional<LigandBonds> known = bonds_by_definition(molecule, 3, given);
  REQUIRE(known.has_value());
  CHECK(known->in_words() == "FOO.cif");
  REQUIRE(known->bonds.size() == 2);
  CHECK(known->bonds[1].order == 2);
  CHECK(molfile_text(molecule, *known) ==
        "LIG\n\n\n  3  2  0  0  0  0  0  0  0  0999 V2000\n"
        "    0.0000    0.0000    0.0000 C   0  0  0  0  0  0  0  0  0  0  0  0\n"
        "    1.2000    0.7000    0.0000 C   0  0  0  0  0  0  0  0  0  0  0  0\n"
        "    2.4000    0.0000    0.0000 O   0  0  0  0  0  0  0  0  0  0  0  0\n"
        "  1  2  1  0\n  2  3  2  0\nM  END\n");
  Molecule other = molecule;
  other.residues[0].name = "BAR";
  CHECK_FALSE(bonds_by_definition(other, 3, given).has_value());
  other = molecule;
  other.atoms[2].name = "O9";
  CHECK_FALSE(bonds_by_definition(other, 3, given).has_value());
  other = molecule;
  other.atoms[2].element = "H";
  CHECK_FALSE(bonds_by_definition(other, 3, given).has_value());
  other = molecule;
  other.positions[2].x += 3;  // torn
  CHECK_FALSE(bonds_by_definition(other, 3, given).has_value());
  other = molecule;
  other.positions[2] = {0.2, 1.3, 0};  // bound to both carbons
  CHECK_FALSE(bonds_by_definition(other, 3, given).has_value());
}

TEST_CASE("bonds_by_definition: an atom may be missing at a single bond, and neighbours are bound by distance") {
  const std::vector<Component> with_oxt{chain("CCO", {1, 1})}, with_double{chain("CCO", {1, 2})};
  Molecule two = zigzag("CC");
  CHECK(bonds_by_definition(two, 2, with_oxt).has_value());
  CHECK_FALSE(bonds_by_definition(two, 2, with_double).has_value());
  // N and C of the next residue, whose oxygen is 1.23 A away.
  for (const auto& [element, place] :
       {std::pair("N", Vec3d{2.4, 0, 0}), {"C", Vec3d{3.6, 0.7, 0}}, {"O", Vec3d{3.6, 1.93, 0}}}) {
    two.atoms.push_back({element, element, 0, true});
    two.positions.push_back(place);
  }
  const std::optional<LigandBonds> known = bonds_by_definition(two, 2, with_oxt);
  REQUIRE(known.has_value());
  std::vector<std::vector<std::size_t>> bonds;
  for (const ComponentBond& bond : known->bonds)
    bonds.push_back({bond.a, bond.b, static_cast<std::size_t>(bond.order)});
  CHECK(bonds == std::vector<std::vector<std::size_t>>{{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 4, 2}});
}

TEST_CASE("acylated_amidines: C-N=C-N-C=O, but no amidine, no guanidine, no imine") {
  const auto found = [](const std::string& elements, const std::vector<int>& orders) {
    const Component component = chain(elements, orders);
    const std::vector<bool> atoms = acylated_amidines(zigzag(elements), {component.bonds, {}, {}});
    return std::vector<bool>(atoms.begin(), atoms.end());
  };
  CHECK(found("CNCNCO", {1, 2, 1, 1, 2}) == std::vector<bool>{false, true, false, false, false, false});
  CHECK(found("CNCNCO", {1, 2, 1, 1, 1}) == std::vector<bool>(6, false));
  CHECK(found("NCNCO", {2, 1, 1, 2}) == std::vector<bool>(5, false));  // a proton of its own
  CHECK(found("CNCCCO", {1, 2, 1, 1, 2}) == std::vector<bool>(6, false));
  Molecule guanidine = zigzag("CNCNCON");
  Component component = chain("CNCNCO", {1, 2, 1, 1, 2});
  component.bonds.push_back({2, 6, 1});
  CHECK(acylated_amidines(guanidine, {component.bonds, {}, {}}) == std::vector<bool>(7, false));
}
