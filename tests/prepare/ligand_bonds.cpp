// ligand_bonds.cpp: bonds of ligands by definitions, and the protons that these refuse.
#include "prepare/charges/ligand_bonds.h"

#include <doctest/doctest.h>

#include "support/test_data.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

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
