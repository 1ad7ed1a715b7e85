// field_kinds.cpp: requests, the table of fields, and the values that kinds give.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>

#include "align/residue_names.h"
#include "base/error.h"
#include "field/field_kinds.h"
#include "support/text.h"

using espdiff::Field;
using espdiff::FieldRequest;
using espdiff::FieldSide;
using espdiff::Molecule;

namespace {

/// One residue with named atoms in a row, 1.4 A apart; hydrogens beside the atom before them.
Molecule residue_of(const std::string& name, const std::vector<std::string>& atoms) {
  Molecule m;
  m.name = "made.pdb";
  m.residues.push_back({name, "A", 7, ' '});
  double x = 0;
  for (const std::string& atom : atoms) {
    espdiff::Atom a;
    a.name = atom;
    a.element = atom.substr(0, 1);
    const bool is_hydrogen = a.element == "H";
    if (!is_hydrogen) x += 1.4;
    m.atoms.push_back(a);
    m.positions.push_back({x, is_hydrogen ? 1.0 : 0.0, 0});
    m.radii.push_back(1.5F);
  }
  return m;
}

std::vector<float> values_of(const std::string& what, const Molecule& molecule) {
  return espdiff::make_fields(espdiff::parse_fields(what)).front().make(molecule, FieldSide::kSource).atoms;
}

std::string refused(const std::string& text) {
  try {
    const auto requests = espdiff::parse_fields(text);
    espdiff::check_fields(requests);
    espdiff::make_fields(requests);
  } catch (const espdiff::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE_BEGIN("field kinds");

TEST_CASE("every kind has a name of its own, words and a unit that tables can show") {
  std::set<std::string> names;
  for (const espdiff::FieldKind& kind : espdiff::field_kinds()) {
    CAPTURE(kind.quantity.name);
    CHECK(names.insert(kind.quantity.name).second);
    CHECK(!kind.quantity.label.empty());
    CHECK(kind.help.size() > 20);
    CHECK(kind.quantity.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos);
    if (kind.argument.empty()) CHECK(!kind.reference.empty());
  }
  CHECK(names.count("hydrophobicity") == 1);
}

TEST_CASE("a request is NAME, KIND:ARGUMENT, or NAME=KIND:ARGUMENT") {
  const auto requests = espdiff::parse_fields("charge|ww=hydrophobicity:octanol|hydrophobicity:eisenberg|donor=");
  REQUIRE(requests.size() == 4);
  CHECK(requests[0].name == "charge");
  CHECK(requests[0].what == "charge");
  CHECK(requests[1].name == "ww");
  CHECK(requests[1].what == "hydrophobicity:octanol");
  CHECK(requests[2].name == "hydrophobicity");
  CHECK(requests[2].what == "hydrophobicity:eisenberg");
  CHECK(requests[3].what == "donor");
}

TEST_CASE("wrong requests are refused in words") {
  CHECK(refused("sweetness").rfind("field: there is no field 'sweetness'; there are: charge, hydrophobicity,", 0) == 0);
  CHECK(refused("gvf") == "field: 'gvf' is a field of the method deform, which deform-field gvf chooses");
  CHECK(refused("1a=charge").rfind("field: the name '1a' of '1a=charge' is not a letter followed by", 0) == 0);
  CHECK(refused("potential=charge").rfind("field: the name 'potential' is taken in results", 0) == 0);
  CHECK(refused("charge:x") == "field: 'charge:x': the field charge takes nothing behind a colon");
  CHECK(refused("residues") == "field: 'residues': the field residues is written residues:FILE.csv[,TARGET.csv]");
  CHECK(refused("residues:a,b,c") ==
        "field: 'residues:a,b,c' is not residues:FILE, or residues:SOURCE_FILE,TARGET_FILE");
  CHECK(refused("charge|charge") ==
        "field: two fields are called 'charge'; name one of them, as in field other=charge");
  CHECK(refused("hydrophobicity:sweet") ==
        "field: there is no scale of hydrophobicity 'sweet'; there are: kyte-doolittle, wimley-white, octanol, "
        "eisenberg");
}

TEST_CASE("scales of hydrophobicity are those in print") {
  // Ile, Trp, Arg, Asp, His of each scale; the sources stand beside the table.
  const std::map<std::string, std::vector<float>> printed = {
      {"hydrophobicity", {4.5F, -0.9F, -4.5F, -3.5F, -3.2F}},
      {"hydrophobicity:wimley-white", {0.31F, 1.85F, -0.81F, -1.23F, -0.17F}},
      {"hydrophobicity:octanol", {1.12F, 2.09F, -1.81F, -3.64F, -0.11F}},
      {"hydrophobicity:eisenberg", {1.38F, 0.81F, -2.53F, -0.90F, -0.40F}}};
  for (const auto& [what, values] : printed) {
    std::size_t i = 0;
    for (const char* const name : {"ILE", "TRP", "ARG", "ASP", "HIE"}) {
      const std::string captured = what + " " + name;
      CAPTURE(captured);
      CHECK(values_of(what, residue_of(name, {"N", "CA"})) == std::vector<float>(2, values[i++]));
    }
  }
  CHECK(refused("hydrophobicity").empty());
}

TEST_CASE("lipophilicity has heavy atoms of amino acids, by residue and name") {
  const auto values = values_of("lipophilicity", residue_of("ILE", {"N", "CA", "CB", "CD", "HA", "OXT"}));
  const double expected[] = {-61.49, -15.71, -0.15, 64.20};  // CHARMM calls CD1 of isoleucine CD
  for (std::size_t i = 0; i < 4; ++i) CHECK(static_cast<double>(values[i]) == doctest::Approx(expected[i]));
  CHECK(std::isnan(values[4]));
  CHECK(std::isnan(values[5]));
}

TEST_CASE("donors have a hydrogen, acceptors a free pair; without hydrogens neither is known") {
  // A serine's hydroxyl gives and takes, an amide's nitrogen gives only.
  const Molecule serine = residue_of("SER", {"N", "H", "CA", "C", "O", "CB", "OG", "HG"});
  CHECK(values_of("donor", serine) == std::vector<float>{1, 1, 0, 0, 0, 0, 1, 1});
  CHECK(values_of("acceptor", serine) == std::vector<float>{0, 0, 0, 0, 1, 0, 1, 0});
  const auto message = [&](const std::string& what) {
    try {
      values_of(what, residue_of("SER", {"N", "CA", "OG"}));
    } catch (const espdiff::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message("donor") ==
        "the source (made.pdb) has none of the field 'Hydrogen bond donors', so that the states cannot be compared by "
        "it; leave the field out, or give a structure that has it");
}

TEST_CASE("B factors of hydrogens that have none are those of their neighbours") {
  Molecule m = residue_of("ALA", {"CA", "HA", "CB"});
  m.atoms[0].b_factor = 12;
  m.atoms[2].b_factor = 30;
  CHECK(values_of("b-factor", m) == std::vector<float>{12, 12, 30});
  CHECK(values_of("confidence", m) == std::vector<float>{12, 12, 30});
}

TEST_CASE("rings are aromatic with their hydrogens") {
  CHECK(values_of("aromatic", residue_of("PHE", {"CB", "HB2", "CG", "CD1", "HD1"})) ==
        std::vector<float>{0, 0, 1, 1, 1});
  CHECK(values_of("aromatic", residue_of("DA", {"P", "N9", "C8"})) == std::vector<float>{0, 1, 1});
}

TEST_SUITE_END();
