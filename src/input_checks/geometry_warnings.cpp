// geometry_warnings.cpp: coordinates that a molecule cannot have: their unit, rounding, bonds, and places taken twice.
#include "input_checks/geometry_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "align/pair_residues.h"
#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"

namespace espdiff {
namespace {

/// Within a residue no bond is longer or shorter; bonds to metals and of iodine reach 2.4 A.
constexpr double kLongestBond_A = 2.5, kShortestBond_A = 0.8;
/// Atoms of two residues that are nearer than any bond, but for those to hydrogen.
constexpr double kSamePlace_A = 1.1;
/// The bonds of a backbone keep within 0.02 A of their lengths (Engh & Huber, Acta Cryst. A 47, 392 (1991)).
constexpr double kMostScale = 0.04, kMostDeviation_A = 0.25, kMostDeviating = 0.2;
/// Shares of the residues from which a fault is that of the whole file.
constexpr double kMostSpoiled = 0.1, kMostOverlapping = 0.05, kMostBare = 0.5;
constexpr std::size_t kLeastSpoiled = 3, kLeastBare = 10, kLeastMeasured = 3, kLeastWholeNumbers = 20;
/// The search for a residue's bonds takes the square of its atoms.
constexpr std::size_t kMostAtomsOfResidue = 400;
constexpr std::size_t kShown = 3;

bool is_chain_residue(ResidueKind kind) { return kind == ResidueKind::kAminoAcid || kind == ResidueKind::kNucleotide; }

bool is_light(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

/// "in 3 residues of the source", with the first ones.
struct SpoiledResidues {
  std::size_t n = 0, n_of_chains = 0;
  std::string examples;

  void add(const ResidueView& view, std::size_t residue, const std::string& what) {
    n_of_chains += is_chain_residue(view.kinds[residue]) ? 1 : 0;
    if (++n <= kShown)
      examples += (n == 1 ? "" : ", ") + residue_label(view.molecule->residues[residue]) + " (" + what + ")";
  }
  std::string count() const { return std::to_string(n) + (n == 1 ? " residue" : " residues"); }
  std::string in_words() const { return examples + (n > kShown ? ", ..." : ""); }
  bool is_systematic(double most_share, std::size_t n_all) const {
    return n_of_chains >= kLeastSpoiled && static_cast<double>(n_of_chains) > most_share * static_cast<double>(n_all);
  }
};

bool has_whole_coordinates(const Molecule& molecule) {
  const auto is_whole = [](double x) { return std::fabs(x - std::round(x)) < 1e-6; };
  return molecule.size() >= kLeastWholeNumbers &&
         std::all_of(molecule.positions.begin(), molecule.positions.end(),
                     [&](const Vec3d& p) { return is_whole(p.x) && is_whole(p.y) && is_whole(p.z); });
}

/// Backbone bonds as multiples of their usual length.
class BackboneBonds {
 public:
  explicit BackboneBonds(const ResidueView& view) : view_(view) {
    for (std::size_t r = 0; r < view.kinds.size(); ++r) {
      if (view.kinds[r] == ResidueKind::kAminoAcid) {
        add(r, "N", "CA", 1.46);
        add(r, "CA", "C", 1.525);
      } else if (view.kinds[r] == ResidueKind::kNucleotide) {
        add(r, "C4'", "C3'", 1.525);
        add(r, "P", "O5'", 1.6);
      }
    }
  }

  bool are_known() const { return ratios_.size() >= kLeastMeasured; }
  double median_ratio() const {
    std::vector<double> sorted = ratios_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }
  double share_deviating() const {
    const auto n = std::count_if(deviations_A_.begin(), deviations_A_.end(),
                                 [](double d) { return std::fabs(d) > kMostDeviation_A; });
    return static_cast<double>(n) / static_cast<double>(deviations_A_.size());
  }

 private:
  const Vec3d* find(std::size_t residue, const char* name) const {
    for (const std::size_t i : view_.atoms[residue]) {
      if (normalized_atom_name(view_.molecule->atoms[i].name) == name) return &view_.molecule->positions[i];
    }
    return nullptr;
  }
  void add(const Vec3d* a, const Vec3d* b, double usual_A) {
    if (a == nullptr || b == nullptr) return;
    const double length = norm(*a - *b);
    ratios_.push_back(length / usual_A);
    deviations_A_.push_back(length - usual_A);
  }
  void add(std::size_t residue, const char* a, const char* b, double usual_A) {
    add(find(residue, a), find(residue, b), usual_A);
  }

  const ResidueView& view_;
  std::vector<double> ratios_, deviations_A_;
};

/// Whether the coordinates of all atoms are wrong, in words; empty if not.
Message wrong_coordinates(const std::string& role, const ResidueView& view) {
  // Points that are no molecule of residues may lie where they like.
  const bool has_chains = std::any_of(view.kinds.begin(), view.kinds.end(), is_chain_residue);
  if (has_chains && has_whole_coordinates(*view.molecule))
    return "the coordinates of the " + role + " are rounded to 1 A, which is coarser than bonds";
  const BackboneBonds bonds(view);
  if (!bonds.are_known()) return {};
  const double ratio = bonds.median_ratio();
  const std::string measured =
      "the median bond of its backbone has " + formatted("%.3g", ratio) + " of its usual length";
  if (ratio > 0.09 && ratio < 0.11)
    return "the coordinates of the " + role + " are in nm: " + measured + "; multiply them by 10";
  if (std::fabs(ratio - 1) > kMostScale) return "the coordinates of the " + role + " are scaled: " + measured;
  const double share = bonds.share_deviating();
  if (share > kMostDeviating)
    return "the coordinates of the " + role + " are too coarse or spoiled: " + percent(share) +
           " of the bonds of its backbone are longer or shorter than usual by more than " + angstrom(kMostDeviation_A);
  return {};
}

/// The longest bond that joins a residue's atoms, and the nearest two atoms.
struct ResidueBonds {
  double longest_A = 0, shortest_A = std::numeric_limits<double>::infinity();
  std::size_t long_atom = 0, near_a = 0, near_b = 0;

  /// By Prim's spanning tree: each atom joins by its shortest distance to those that are joined.
  ResidueBonds(const Molecule& molecule, const std::vector<std::size_t>& atoms) {
    std::vector<double> square(atoms.size(), std::numeric_limits<double>::infinity());
    std::vector<bool> joined(atoms.size(), false);
    std::size_t last = 0;
    joined[0] = true;
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    for (std::size_t n = 1; n < atoms.size(); ++n) {
      std::size_t next = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < atoms.size(); ++k) {
        if (joined[k]) continue;
        const Vec3d d = molecule.positions[atoms[k]] - molecule.positions[atoms[last]];
        const double own = dot(d, d);
        if (own < shortest) {
          shortest = own;
          near_a = atoms[last];
          near_b = atoms[k];
        }
        square[k] = std::min(square[k], own);
        if (square[k] >= least) continue;
        least = square[k];
        next = k;
      }
      if (!std::isfinite(least)) return;
      if (least > longest) {
        longest = least;
        long_atom = atoms[next];
      }
      joined[next] = true;
      last = next;
    }
    longest_A = std::sqrt(longest);
    shortest_A = std::sqrt(shortest);
  }
};

void check_bonds(const std::string& role, const ResidueView& view, std::size_t n_chain_residues,
                 std::vector<Warning>& warnings) {
  SpoiledResidues torn, crowded;
  const std::vector<Atom>& atoms = view.molecule->atoms;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    const std::size_t n = view.atoms[r].size();
    if (view.kinds[r] == ResidueKind::kWater || n < 2 || n > kMostAtomsOfResidue) continue;
    const ResidueBonds bonds(*view.molecule, view.atoms[r]);
    if (bonds.longest_A > kLongestBond_A)
      torn.add(view, r, atoms[bonds.long_atom].name + " " + angstrom(bonds.longest_A) + " from the rest");
    if (bonds.shortest_A < kShortestBond_A)
      crowded.add(
          view, r,
          atoms[bonds.near_a].name + " and " + atoms[bonds.near_b].name + " " + angstrom(bonds.shortest_A) + " apart");
  }
  if (torn.n > 0)
    warnings.push_back({torn.count() + " of the " + role + (torn.n == 1 ? " has a gap" : " have gaps") +
                            " that no bond spans: " + torn.in_words(),
                        torn.is_systematic(kMostSpoiled, n_chain_residues)});
  if (crowded.n > 0)
    warnings.push_back({crowded.count() + " of the " + role + (crowded.n == 1 ? " has" : " have") +
                            " atoms nearer to each other than any bond: " + crowded.in_words(),
                        crowded.is_systematic(kMostSpoiled, n_chain_residues)});
}

/// Heavy atoms in cubes that are larger than the distance that is looked for: most atoms look into one.
class PlaceCells {
 public:
  explicit PlaceCells(const ResidueView& view) : view_(view) {
    for (std::size_t r = 0; r < view.kinds.size(); ++r) {
      if (view.kinds[r] == ResidueKind::kWater) continue;
      for (const std::size_t i : view.atoms[r]) {
        if (!is_light(view.molecule->atoms[i])) cells_[cubes(view.molecule->positions[i], 0).front()].push_back(i);
      }
    }
  }

  /// A residue with an atom on the place of an atom of `residue`; -1 for none.
  std::int32_t on_place_of(std::size_t residue) const {
    const Molecule& molecule = *view_.molecule;
    for (const std::size_t i : view_.atoms[residue]) {
      if (is_light(molecule.atoms[i])) continue;
      for (const std::uint64_t cube : cubes(molecule.positions[i], kSamePlace_A)) {
        const auto found = cells_.find(cube);
        if (found == cells_.end()) continue;
        for (const std::size_t j : found->second) {
          const std::int32_t other = molecule.atoms[j].residue;
          if (other != static_cast<std::int32_t>(residue) &&
              norm(molecule.positions[i] - molecule.positions[j]) < kSamePlace_A)
            return other;
        }
      }
    }
    return -1;
  }

 private:
  static constexpr double kEdge_A = 4 * kSamePlace_A;

  /// The cubes within a distance of p.
  static std::vector<std::uint64_t> cubes(const Vec3d& p, double distance_A) {
    std::vector<std::uint64_t> found{0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = [&](double x) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / kEdge_A))) & 0x1fffffU;
      };
      const std::uint64_t low = place(p[axis] - distance_A), high = place(p[axis] + distance_A);
      const std::size_t n = found.size();
      for (std::size_t k = 0; k < n; ++k) {
        if (high != low) found.push_back(found[k] << 21U | high);
        found[k] = found[k] << 21U | low;
      }
    }
    return found;
  }

  const ResidueView& view_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

/// Residues that lie on each other, as where a file holds a chain twice or both states.
void check_places(const std::string& role, const ResidueView& view, std::size_t n_chain_residues,
                  std::vector<Warning>& warnings) {
  const PlaceCells cells(view);
  SpoiledResidues overlapping;
  std::map<std::pair<std::string, std::string>, std::size_t> chains;
  const std::vector<Residue>& residues = view.molecule->residues;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    if (view.kinds[r] == ResidueKind::kWater) continue;
    const std::int32_t other = cells.on_place_of(r);
    if (other < 0) continue;
    const Residue& there = residues[static_cast<std::size_t>(other)];
    overlapping.add(view, r, "on " + residue_label(there));
    if (residues[r].chain != there.chain) ++chains[std::minmax(residues[r].chain, there.chain)];
  }
  if (overlapping.n == 0) return;
  const bool refuses = overlapping.is_systematic(kMostOverlapping, n_chain_residues);
  Message text = overlapping.count() + " of the " + role + (overlapping.n == 1 ? " lies" : " lie") +
                 " on the place of another: " + overlapping.in_words();
  const auto most =
      std::max_element(chains.begin(), chains.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (refuses && most != chains.end())
    text += "; chain " + most->first.second + " lies on chain " + most->first.first +
            ", as where one file holds two states or a chain twice: give one of them (" + option("select") + ")";
  warnings.push_back({text, refuses});
}

/// Amino acids of which only the backbone, with C-beta or without, is there; glycine and alanine do not tell.
void check_side_chains(const std::string& role, const ResidueView& view, std::vector<Warning>& warnings) {
  std::size_t n = 0, n_bare = 0;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    const char letter = residue_letter(view.molecule->residues[r].name);
    if (view.kinds[r] != ResidueKind::kAminoAcid || letter == '?' || letter == 'G' || letter == 'A') continue;
    ++n;
    const auto heavy = std::count_if(view.atoms[r].begin(), view.atoms[r].end(), [&](std::size_t i) {
      const Atom& atom = view.molecule->atoms[i];
      return !is_light(atom) && normalized_atom_name(atom.name) != "OXT";
    });
    constexpr std::ptrdiff_t kBackboneAndBeta = 5;  // all others have more
    n_bare += heavy <= kBackboneAndBeta ? 1 : 0;
  }
  if (n < kLeastBare || static_cast<double>(n_bare) <= kMostBare * static_cast<double>(n)) return;
  warnings.push_back({std::to_string(n_bare) + " of " + std::to_string(n) + " residues of the " + role +
                          " have no side chains: its surface is not that of the molecule; give all atoms",
                      true});
}

}  // namespace

void check_geometry(const char* role, const ResidueView& view, std::vector<Warning>& warnings) {
  const Message systematic = wrong_coordinates(role, view);
  if (!systematic.empty()) warnings.push_back({systematic, true});
  check_side_chains(role, view, warnings);
  if (!systematic.empty()) return;  // single bonds would be named for the same reason
  const auto n_chain_residues =
      static_cast<std::size_t>(std::count_if(view.kinds.begin(), view.kinds.end(), is_chain_residue));
  check_bonds(role, view, n_chain_residues, warnings);
  check_places(role, view, n_chain_residues, warnings);
}

}  // namespace espdiff
