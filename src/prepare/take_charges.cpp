// take_charges.cpp: pairs the atoms of two states and copies their values.
#include "prepare/take_charges.h"

#include <algorithm>
#include <vector>

#include "align/pair_atoms.h"
#include "base/error.h"

namespace espdiff {
namespace {

/// Without pairs where too few atoms pair.
AtomPairing pairing_or_none(const Molecule& molecule, const Molecule& frame) {
  try {
    return pair_atoms(molecule, frame, PairOthers::kByNumber);
  } catch (const InputError&) {
    return {};
  }
}

std::string name_of(const Molecule& molecule, std::size_t atom) {
  const Atom& a = molecule.atoms[atom];
  const Residue& residue = molecule.residues[static_cast<std::size_t>(a.residue)];
  return a.name + " of " + residue.name + " " + (residue.chain.empty() ? "" : residue.chain + " ") +
         std::to_string(residue.number);
}

/// The first atom that is in no pair.
template <typename AtomOf>
std::string first_unpaired(const Molecule& molecule, const AtomPairing& pairing, AtomOf atom_of) {
  std::vector<bool> is_paired(molecule.size(), false);
  for (const auto& pair : pairing.pairs) is_paired[atom_of(pair)] = true;
  const auto first = std::find(is_paired.begin(), is_paired.end(), false);
  return first == is_paired.end() ? std::string()
                                  : name_of(molecule, static_cast<std::size_t>(first - is_paired.begin()));
}

}  // namespace

void take_values(Molecule& frame, const Molecule& molecule, const std::string& name) {
  if (!frame.charges.empty()) return;
  const AtomPairing pairing = pairing_or_none(molecule, frame);
  if (pairing.pairs.size() != frame.size() || pairing.pairs.size() != molecule.size()) {
    const std::string missing = first_unpaired(molecule, pairing, [](const auto& pair) { return pair.first; });
    const std::string extra = first_unpaired(frame, pairing, [](const auto& pair) { return pair.second; });
    throw InputError(name + " has no charges and radii, and cannot take those of " + molecule.name + ": " +
                     (missing.empty() ? "" : "it lacks " + missing) + (missing.empty() || extra.empty() ? "" : ", ") +
                     (extra.empty() ? "" : extra + " is not in " + molecule.name) + " (" +
                     std::to_string(frame.size()) + " and " + std::to_string(molecule.size()) +
                     " atoms); give frames and source of the same atoms, or frames as PQR");
  }
  frame.charges.assign(frame.size(), 0);
  for (const auto& [from, to] : pairing.pairs) {
    frame.charges[to] = molecule.charges[from];
    frame.radii[to] = molecule.radii[from];
  }
  frame.radii_origin = molecule.radii_origin;
}

bool has_same_atoms(const Molecule& frame, const Molecule& molecule) {
  return frame.size() == molecule.size() && pairing_or_none(molecule, frame).pairs.size() == frame.size();
}

}  // namespace espdiff
