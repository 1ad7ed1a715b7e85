// read_component.cpp: definitions of the Chemical Component Dictionary and of monomer libraries.
#include "io/structures/read_component.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "support/test_data.h"

#ifdef ESPDIFF_HAVE_GEMMI

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

std::string atoms_of(const std::string& rows, const std::string& charge = "charge") {
  return "loop_\n_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\n_chem_comp_atom.type_symbol\n_chem_comp_atom." +
         charge + "\n" + rows;
}

std::string bonds_of(const std::string& rows, const std::string& order = "value_order") {
  return "loop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n_chem_comp_bond." +
         order + "\n" + rows;
}

std::vector<Component> components(const std::string& text) {
  const ScratchFolder folder;
  return read_components(folder.write("X.cif", text));
}

/// "C1-C2 2": the atoms of each bond, and its order.
std::vector<std::string> bonds_in_words(const Component& component) {
  std::vector<std::string> words;
  for (const ComponentBond& bond : component.bonds)
    words.push_back(component.atoms[bond.a].name + "-" + component.atoms[bond.b].name + " " +
                    std::to_string(bond.order));
  return words;
}

}  // namespace

TEST_CASE("read_components: heavy atoms, orders, and charges that no proton makes") {
  const std::vector<Component> all = components(
      "data_NIT\n" +
      atoms_of("NIT C1 C 0\nNIT N1 N 1\nNIT O1 O 0\nNIT O2 O -1\nNIT N2 N 1\nNIT H1 H 0\nNIT O3 O -1\n") +
      bonds_of("NIT C1 N1 SING\nNIT N1 O1 DOUB\nNIT N1 O2 SING\nNIT C1 N2 SING\nNIT N2 H1 SING\nNIT C1 O3 SING\n") +
      "data_NIL\n" + atoms_of("NIL C1 C 0\nNIL N1 N 0\n") + bonds_of("NIL C1 N1 TRIP\n"));
  REQUIRE(all.size() == 2);
  CHECK(all[0].name == "NIT");
  CHECK(bonds_in_words(all[0]) == std::vector<std::string>{"C1-N1 1", "N1-O1 2", "N1-O2 1", "C1-N2 1", "C1-O3 1"});
  std::vector<int> charges;
  for (const ComponentAtom& atom : all[0].atoms) charges.push_back(atom.charge);
  // Of the nitro group; an ammonium and an alcoholate depend on the pH.
  CHECK(charges == std::vector<int>{0, 1, 0, -1, 0, 0});
  CHECK(bonds_in_words(all[1]) == std::vector<std::string>{"C1-N1 3"});
}

TEST_CASE("read_components: a delocalized group gets one double bond, not to OXT") {
  const std::vector<Component> all =
      components("data_comp_ACI\n" +
                 atoms_of("ACI CA C 0\nACI C C 0\nACI OXT O -0.5\nACI O O -0.5\nACI P P 0\nACI O1 O -0.666\n"
                          "ACI O2 O -0.666\nACI O3 O -0.666\n",
                          "partial_charge") +
                 bonds_of("ACI C CA single\nACI OXT C deloc\nACI O C deloc\nACI P CA single\nACI P O1 deloc\n"
                          "ACI O2 P deloc\nACI P O3 deloc\n",
                          "type"));
  REQUIRE(all.size() == 1);
  CHECK(all[0].name == "ACI");
  CHECK(bonds_in_words(all[0]) ==
        std::vector<std::string>{"C-CA 1", "OXT-C 1", "O-C 2", "P-CA 1", "P-O1 2", "O2-P 1", "P-O3 1"});
  for (const ComponentAtom& atom : all[0].atoms) CHECK(atom.charge == 0);
}

TEST_CASE("read_components: of an ester that is called delocalized, the oxygen at the end has the double bond") {
  const std::vector<Component> all =
      components("data_EST\n" + atoms_of("EST C1 C 0\nEST O1 O 0\nEST O2 O 0\nEST C2 C 0\n") +
                 bonds_of("EST C1 O1 deloc\nEST C1 O2 deloc\nEST O1 C2 single\n", "type"));
  REQUIRE(all.size() == 1);
  CHECK(bonds_in_words(all[0]) == std::vector<std::string>{"C1-O1 1", "C1-O2 2", "O1-C2 1"});
}

TEST_CASE("read_components: what has no orders, no bonds, or is no CIF") {
  const std::string nothing =
      "X.cif: no chemical component with atoms and bonds (_chem_comp_atom, _chem_comp_bond), and without metals, is in "
      "it; give a ligand's file of the Chemical Component Dictionary, or a MOL2 file";
  for (const std::string& text :
       {"data_X\n" + atoms_of("X FE FE 0\nX N N 0\n") + bonds_of("X FE N SING\n"),
        "data_X\n" + atoms_of("X C1 C 0\nX C2 C 0\n") + bonds_of("X C1 C2 .\n"),
        "data_X\n" + atoms_of("X C1 C 0\nX C2 C 0\n"), std::string("data_X\n_cell.length_a 1\n")}) {
    const std::string message = message_of([&] { components(text); });
    CHECK(message.substr(message.find("X.cif")) == nothing);
  }
  const std::string broken = message_of([] { components("data_X\nloop_\n_a.b\n_a.c\n1\n"); });
  CHECK(broken.find("not valid CIF: the values of a loop do not fill its columns") != std::string::npos);
  const std::string unknown =
      message_of([] { components("data_X\n" + atoms_of("X C1 C 0\nX C2 C 0\n") + bonds_of("X C1 C2 MANY\n")); });
  CHECK(unknown.find("the components cannot be read: its text does not follow the format") != std::string::npos);
}

TEST_CASE("component_of_library: by name and folder; what cannot be read is not there") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.file("f"));
  folder.write("f/FOO.cif", "data_comp_list\n_chem_comp.id FOO\ndata_comp_FOO\n" +
                                atoms_of("FOO C1 C 0\nFOO C2 C 0\n") + bonds_of("FOO C1 C2 DOUB\n"));
  folder.write("f/FAR.cif", "data_FAR\nloop_\n_a.b\n");
  setenv("CLIBD_MON", folder.file("").c_str(), 1);
  CHECK(has_monomer_library());
  REQUIRE(component_of_library("FOO").has_value());
  CHECK(component_of_library("FOO")->bonds.front().order == 2);
  CHECK_FALSE(component_of_library("FAR").has_value());
  CHECK_FALSE(component_of_library("BAR").has_value());
  CHECK_FALSE(component_of_library("../f/FOO").has_value());
  setenv("CLIBD_MON", "", 1);
  CHECK_FALSE(has_monomer_library());
  CHECK_FALSE(component_of_library("FOO").has_value());
}

#endif
