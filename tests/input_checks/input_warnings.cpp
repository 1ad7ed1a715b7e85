// input_warnings.cpp: errors of correspondence are named, and right pairs that look wrong are not refused; by the
// checks of the inputs alone, without surfaces.
#include "input_checks/input_warnings.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "input_checks/planted_pairing.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Alignment;
using espdiff::Molecule;

namespace {

Molecule one_chain(const Molecule& molecule, const std::string& chain) {
  Molecule result;
  std::vector<std::int32_t> place(molecule.residues.size(), -1);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const auto r = static_cast<std::size_t>(molecule.atoms[i].residue);
    if (molecule.residues[r].chain != chain) continue;
    if (place[r] < 0) {
      place[r] = static_cast<std::int32_t>(result.residues.size());
      result.residues.push_back(molecule.residues[r]);
    }
    result.atoms.push_back(molecule.atoms[i]);
    result.atoms.back().residue = place[r];
    result.positions.push_back(molecule.positions[i]);
    result.radii.push_back(molecule.radii[i]);
  }
  return result;
}

std::string all_of(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += warning + "\n";
  return text;
}

}  // namespace

TEST_SUITE_BEGIN("input_warnings");

TEST_CASE("exchanged side chains, shifted stretches and moved parts are named; short chains and gaps are right") {
  const auto path = real_input("pairs/1ake.pdb");
  if (!path) return;
  const Molecule both = espdiff::read_structure(*path, espdiff::StructureOptions{});
  const Molecule a = one_chain(both, "A"), b = one_chain(both, "B");
  const std::vector<PlacedError> errors = pairing_errors(a, b, 1);
  CHECK(errors.size() >= 18);
  for (const PlacedError& error : errors) {
    Alignment result;
    const std::vector<std::string> warnings = warnings_of(error, result);
    CAPTURE(error.kind);
    CAPTURE(all_of(warnings));
    CHECK(is_judged_rightly(error, result, warnings));
  }
  Alignment result;
  CHECK(all_of(warnings_of({"", "", {a, b}}, result)).find('*') == std::string::npos);
}

TEST_CASE("a gap that only one state has refuses, and one that both have is a note") {
  const auto path = real_input("t4l/181L.pdb");
  if (!path) return;
  const Molecule whole = one_chain(espdiff::read_structure(*path, espdiff::StructureOptions{}), "A");
  // Six residues less, and the others numbered as if they were not missing.
  Molecule gap;
  std::vector<std::int32_t> place(whole.residues.size(), -1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const auto r = static_cast<std::size_t>(whole.atoms[i].residue);
    if (whole.residues[r].number >= 54 && whole.residues[r].number < 60) continue;
    if (place[r] < 0) {
      place[r] = static_cast<std::int32_t>(gap.residues.size());
      gap.residues.push_back(whole.residues[r]);
      if (whole.residues[r].number >= 60) gap.residues.back().number -= 6;
    }
    gap.atoms.push_back(whole.atoms[i]);
    gap.atoms.back().residue = place[r];
    gap.positions.push_back(whole.positions[i]);
    gap.radii.push_back(whole.radii[i]);
  }
  Alignment result;
  const std::string alike = all_of(warnings_of({"", "", {gap, gap}}, result));
  CHECK(alike.find("source and target are broken alike in 1 place, where neighbours lie farther apart than a chain "
                   "reaches: ASN 53 of chain A and ") == 0);
  Molecule far = gap;
  for (std::size_t i = 0; i < far.size(); ++i) {
    if (far.residues[static_cast<std::size_t>(far.atoms[i].residue)].number >= 54) far.positions[i] += {60, 0, 0};
  }
  CHECK(all_of(warnings_of({"", "", {gap, far}}, result)).find("*the target is broken in 1 place") !=
        std::string::npos);
  CHECK(all_of(warnings_of({"", "", {far, far}}, result)).find("*the source is broken in 1 place") !=
        std::string::npos);
}

TEST_SUITE_END();
