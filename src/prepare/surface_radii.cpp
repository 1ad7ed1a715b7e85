// surface_radii.cpp: tells force fields apart by the radii that they give to the same atom of the same residue.
#include "prepare/surface_radii.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "io/molecules/elements.h"

namespace espdiff {
namespace {

/// [residue name, atom name] the first radius.
using RadiusTable = std::map<std::pair<std::string, std::string>, float>;

RadiusTable table_of(const Molecule& molecule) {
  RadiusTable table;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Atom& atom = molecule.atoms[i];
    table.try_emplace({molecule.residues[static_cast<std::size_t>(atom.residue)].name, atom.name}, molecule.radii[i]);
  }
  return table;
}

bool have_one_force_field(const Molecule& a, const Molecule& b) {
  constexpr float kSame_A = 0.01F;
  constexpr double kShare = 0.9;
  const RadiusTable of_a = table_of(a), of_b = table_of(b);
  std::size_t n_common = 0, n_same = 0;
  for (const auto& [name, radius] : of_a) {
    const auto found = of_b.find(name);
    if (found == of_b.end()) continue;
    ++n_common;
    n_same += std::fabs(found->second - radius) <= kSame_A ? 1 : 0;
  }
  return n_common == 0 || static_cast<double>(n_same) >= kShare * static_cast<double>(n_common);
}

void take_element_radii(Molecule& molecule) {
  for (std::size_t i = 0; i < molecule.size(); ++i) molecule.radii[i] = element_radius(molecule.atoms[i].element);
  molecule.radii_origin = ValueOrigin::kElement;
}

}  // namespace

std::string radii_conflict(const Molecule& a, const Molecule& b) {
  if (a.radii_origin != b.radii_origin) return "only some of the structures have radii of their own";
  if (a.radii_origin != ValueOrigin::kFile || have_one_force_field(a, b)) return {};
  return "the radii of the structures are of different force fields";
}

void set_frame_radii(const Molecule& source, Molecule& frame, RadiiChoice choice) {
  set_surface_radii({&frame}, choice);
  if (choice != RadiiChoice::kAuto || source.size() == 0) return;
  if (radii_conflict(source, frame).empty()) return;
  throw InputError(
      frame.name + ": its radii are not of the kind that " + source.name + " has (" +
      (frame.radii_origin == source.radii_origin ? "another force field" : "only one of them has radii of its own") +
      "), so that their surfaces differ everywhere; " + option("radii", "element") + " gives both Bondi's");
}

std::string set_surface_radii(const std::vector<Molecule*>& molecules, RadiiChoice choice) {
  if (choice == RadiiChoice::kFile) {
    for (const Molecule* molecule : molecules) {
      if (molecule->radii_origin == ValueOrigin::kElement)
        throw InputError(molecule->name + ": " + option("radii", "file") +
                         " was asked for, and the file has no radii; take " + option("radii", "element"));
    }
    return {};
  }
  if (choice == RadiiChoice::kElement) {
    for (Molecule* molecule : molecules) take_element_radii(*molecule);
    return {};
  }
  if (molecules.empty()) return {};
  std::string why;
  for (const Molecule* molecule : molecules) {
    const std::string conflict = radii_conflict(*molecules.front(), *molecule);
    if (!conflict.empty()) why = conflict;
  }
  if (why.empty()) return {};
  for (Molecule* molecule : molecules) take_element_radii(*molecule);
  return why + "; all surfaces take Bondi's radii by element";
}

}  // namespace espdiff
