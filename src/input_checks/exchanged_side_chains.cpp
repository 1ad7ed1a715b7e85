// exchanged_side_chains.cpp: finds residues of one type whose side chains lie in each other's places.
#include "input_checks/exchanged_side_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "input_checks/surroundings.h"

namespace espdiff {
namespace {

/// A side chain that left its place lies farther from it than this and than twice the distance to another's place,
/// where it lies within this: centres of long side chains lie up to 4 A apart in different rotamers.
constexpr double kLeftPlace_A = 3, kInPlace_A = 4.5, kCloser = 0.5;
constexpr std::size_t kMostExchangesNamed = 3, kMostInRing = 50;

bool belongs_to_backbone(const std::string& name, ResidueKind kind) {
  if (kind == ResidueKind::kNucleotide)
    return name.find('\'') != std::string::npos || name.find('*') != std::string::npos || name.find('P') == 0 ||
           name == "OP1" || name == "OP2" || name == "O1P" || name == "O2P";
  return name == "N" || name == "CA" || name == "C" || name == "O" || name == "OXT" || name == "OT1" || name == "OT2";
}

/// The centre of a side chain or base, without hydrogens; empty for residues that have none.
std::optional<Vec3d> side_centre(const ResidueView& view, std::size_t residue) {
  Vec3d sum{};
  double n = 0;
  for (const std::size_t i : view.atoms[residue]) {
    const Atom& atom = view.molecule->atoms[i];
    const bool is_hydrogen = atom.element == "H" || atom.element == "D";
    if (is_hydrogen || belongs_to_backbone(atom.name, view.kinds[residue])) continue;
    sum += view.molecule->positions[i];
    ++n;
  }
  if (n == 0) return std::nullopt;
  return (1 / n) * sum;
}

/// A residue of the source, where its side chain is expected on the target, and where its partner has it.
struct SideChain {
  std::size_t residue;
  Vec3d expected, found;

  double misplaced() const { return norm(expected - found); }
};

/// By the letter that source and target share.
std::map<char, std::vector<SideChain>> side_chains(const PairedMolecules& pair) {
  std::map<char, std::vector<SideChain>> by_letter;
  for (std::size_t r = 0; r < pair.target_of.size(); ++r) {
    if (!pair.motions[r]) continue;
    const auto t = static_cast<std::size_t>(pair.target_of[r]);
    const char letter = residue_letter(pair.source.molecule->residues[r].name);
    if (letter == '?' || letter != residue_letter(pair.target.molecule->residues[t].name)) continue;
    const auto here = side_centre(pair.source, r), there = side_centre(pair.target, t);
    if (here && there) by_letter[letter].push_back({r, pair.motions[r]->apply(*here), *there});
  }
  return by_letter;
}

/// [of the list] whose place a side chain took, itself if none.
std::vector<std::size_t> places_taken(const std::vector<SideChain>& all) {
  std::vector<std::size_t> taken(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    taken[k] = k;
    const double own = all[k].misplaced();
    if (own < kLeftPlace_A) continue;
    double nearest = std::min(kInPlace_A, kCloser * own);
    for (std::size_t j = 0; j < all.size(); ++j) {
      const double distance = norm(all[j].expected - all[k].found);
      if (j == k || distance >= nearest || all[j].misplaced() < kLeftPlace_A) continue;
      nearest = distance;
      taken[k] = j;
    }
  }
  return taken;
}

}  // namespace

void check_side_chains(const PairedMolecules& pair, std::vector<Warning>& warnings) {
  const Molecule& molecule = *pair.source.molecule;
  std::size_t n = 0, n_named = 0;
  std::string names;
  for (const auto& [letter, all] : side_chains(pair)) {
    const std::vector<std::size_t> taken = places_taken(all);
    std::vector<bool> listed(all.size(), false);
    for (std::size_t k = 0; k < all.size(); ++k) {
      // Only a ring of places tells an exchange from one side chain that swung over to another's place.
      std::size_t length = 1, at = taken[k];
      for (; at != k && taken[at] != at && length < kMostInRing; ++length) at = taken[at];
      if (at != k || length < 2) continue;
      ++n;
      if (listed[k] || n_named >= kMostExchangesNamed) continue;
      ++n_named;
      std::string ring = residue_label(molecule.residues[all[k].residue]);
      listed[k] = true;
      for (at = taken[k]; at != k; at = taken[at]) {
        ring += " and " + residue_label(molecule.residues[all[at].residue]);
        listed[at] = true;
      }
      names += (names.empty() ? "" : "; ") + ring;
    }
  }
  if (n == 0) return;
  warnings.push_back(
      {"the side chains of " + std::to_string(n) + " residues lie in the places of others of their type (" + names +
           (n > 2 * n_named ? "; ..." : "") + "): atoms or numbers of residues were exchanged in one molecule",
       true});
}

}  // namespace espdiff
