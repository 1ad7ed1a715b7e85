// side_chains.cpp: turns side chains about their bonds, and refuses what clashes.
#include "causes/side_chains.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "align/residue_names.h"
#include "base/counter_random.h"
#include "causes/chi_angles.h"

namespace espdiff {
namespace {

bool is_heavy(const Atom& atom) { return atom.element != "H" && atom.element != "D"; }

bool is_polar(const Atom& atom) { return atom.element == "N" || atom.element == "O" || atom.element == "S"; }

bool clash(const Atom& a, Vec3d at, const Atom& b, Vec3d other) {
  const Vec3d d = at - other;
  const double least = is_polar(a) && is_polar(b) ? kPolarClash_A : kClash_A;
  return dot(d, d) < least * least;
}

/// Angles of the grid about one bond, degrees. @param chi from 1, of n_chi
std::vector<double> grid_angles(char letter, int chi, int n_chi) {
  const std::string planar = "NDQEHFWY";
  if (chi == n_chi && planar.find(letter) != std::string::npos) {
    if (is_symmetric_end(letter)) return {0, 60, 120};
    return {0, 60, 120, 180, 240, 300};
  }
  constexpr int kArginineEnd = 4;
  if (letter == 'R' && chi == kArginineEnd) return {180, 90, -90};
  return {180, 60, -60};
}

/// One residue whose side chain is turned.
class TurnedSideChain {
 public:
  /// @param atoms of the residue
  TurnedSideChain(const Molecule& molecule, const std::vector<std::size_t>& atoms) : molecule_(molecule) {
    letter_ = residue_letter(molecule.residues[static_cast<std::size_t>(molecule.atoms[atoms.front()].residue)].name);
    for (const std::string& name : side_chain_bonds(letter_)) {
      const auto is_it = [&](std::size_t i) { return normalized_atom_name(molecule.atoms[i].name, letter_) == name; };
      const auto found = std::find_if(atoms.begin(), atoms.end(), is_it);
      if (found == atoms.end()) return;
      chain_.push_back(*found);
    }
    for (std::size_t k = 1; k + 2 < chain_.size(); ++k) {
      beyond_.push_back(atoms_beyond(atoms, chain_[k], chain_[k + 1]));
      if (std::count(beyond_.back().begin(), beyond_.back().end(), chain_[k - 1]) > 0)
        beyond_.back().clear();  // a ring
      can_turn_ = can_turn_ && !beyond_.back().empty();
    }
    can_turn_ = can_turn_ && !beyond_.empty();
    if (!can_turn_) return;
    for (const std::size_t i : beyond_.front()) {
      if (i != chain_[2]) moving_.push_back(i);  // CB lies on the first axis
    }
  }

  bool can_turn() const { return can_turn_; }
  const std::vector<std::size_t>& moving_atoms() const { return moving_; }

  /// [placement][angle] degrees: all combinations.
  std::vector<std::vector<double>> grid() const {
    std::vector<std::vector<double>> all{{}};
    const auto n = static_cast<int>(beyond_.size());
    for (int k = 1; k <= n; ++k) {
      std::vector<std::vector<double>> longer;
      for (const std::vector<double>& angles : all) {
        for (const double angle : grid_angles(letter_, k, n)) {
          longer.push_back(angles);
          longer.back().push_back(angle);
        }
      }
      all = std::move(longer);
    }
    return all;
  }

  /// [angle] degrees, as the file has them.
  std::vector<double> file_angles() const {
    std::vector<double> angles;
    const auto& at = molecule_.positions;
    for (std::size_t k = 0; k < beyond_.size(); ++k)
      angles.push_back(dihedral(at[chain_[k]], at[chain_[k + 1]], at[chain_[k + 2]], at[chain_[k + 3]]));
    return angles;
  }

  /// [moving atom] with these angles.
  std::vector<Vec3d> placed(const std::vector<double>& angles) const {
    std::map<std::size_t, Vec3d> at = file_places();
    for (std::size_t k = 0; k < angles.size(); ++k) turn_to(at, k, angles[k]);
    std::vector<Vec3d> places;
    for (const std::size_t i : moving_atoms()) places.push_back(at[i]);
    return places;
  }

  /// Whether the atom, of a side chain that moves, is so near to the backbone along the bonds that it cannot avoid it.
  bool is_next_to_backbone(std::size_t atom) const {
    return beyond_.size() < 2 || atom == chain_[3] || std::count(beyond_[1].begin(), beyond_[1].end(), atom) == 0;
  }

 private:
  /// The atoms that bonds reach from `to` without `from`.
  std::vector<std::size_t> atoms_beyond(const std::vector<std::size_t>& atoms, std::size_t from, std::size_t to) const {
    std::vector<std::size_t> reached{to};
    for (std::size_t next = 0; next < reached.size(); ++next) {
      for (const std::size_t i : atoms) {
        if (i == from || std::count(reached.begin(), reached.end(), i) > 0 || !bonded(reached[next], i)) continue;
        reached.push_back(i);
      }
    }
    // The bond's own end stays on its axis; what hangs on it turns.
    std::sort(reached.begin(), reached.end());
    return reached;
  }

  bool bonded(std::size_t a, std::size_t b) const {
    constexpr double kHeavy_A = 1.95, kHydrogen_A = 1.25;
    const bool heavy = is_heavy(molecule_.atoms[a]) && is_heavy(molecule_.atoms[b]);
    return norm(molecule_.positions[a] - molecule_.positions[b]) < (heavy ? kHeavy_A : kHydrogen_A);
  }

  std::map<std::size_t, Vec3d> file_places() const {
    std::map<std::size_t, Vec3d> at;
    for (const std::size_t i : chain_) at[i] = molecule_.positions[i];
    for (const std::size_t i : moving_atoms()) at[i] = molecule_.positions[i];
    return at;
  }

  /// Turns angle k, from 0, to so many degrees (Rodrigues' rotation).
  void turn_to(std::map<std::size_t, Vec3d>& at, std::size_t k, double degrees) const {
    const Vec3d b = at[chain_[k + 1]], c = at[chain_[k + 2]];
    const double angle = (degrees - dihedral(at[chain_[k]], b, c, at[chain_[k + 3]])) * kPi / 180;
    const Vec3d axis = (1 / norm(c - b)) * (c - b);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (const std::size_t i : beyond_[k]) {
      const Vec3d d = at[i] - c;
      at[i] = c + cosine * d + sine * cross(axis, d) + ((1 - cosine) * dot(axis, d)) * axis;
    }
  }

  const Molecule& molecule_;
  char letter_ = '?';
  std::vector<std::size_t> chain_;                ///< of the bonds, from N
  std::vector<std::vector<std::size_t>> beyond_;  ///< [angle] what it turns
  std::vector<std::size_t> moving_;
  bool can_turn_ = true;
};

/// Whether a placement clashes with atoms of other residues that stay in place, or with its own backbone.
bool clashes(const Molecule& m, const TurnedSideChain& chain, const std::vector<std::size_t>& own,
             const std::vector<Vec3d>& places, const std::vector<std::size_t>& nearby) {
  const std::vector<std::size_t>& atoms = chain.moving_atoms();
  for (std::size_t n = 0; n < atoms.size(); ++n) {
    const Atom& atom = m.atoms[atoms[n]];
    if (!is_heavy(atom)) continue;
    for (const std::size_t other : nearby)
      if (clash(atom, places[n], m.atoms[other], m.positions[other])) return true;
    if (chain.is_next_to_backbone(atoms[n])) continue;
    for (const std::size_t other : own) {
      const std::string& name = m.atoms[other].name;
      if ((name == "N" || name == "C" || name == "O") && clash(atom, places[n], m.atoms[other], m.positions[other]))
        return true;
    }
  }
  return false;
}

/// Heavy atoms of other residues near a residue that stay in place.
std::vector<std::size_t> fixed_neighbours(const Molecule& m, const std::vector<std::size_t>& own,
                                          const std::vector<bool>& moves) {
  constexpr double kReach_A = 13;  // arginine's length, and a clash
  std::vector<std::size_t> near;
  const Vec3d centre = m.positions[own.front()];
  const std::int32_t residue = m.atoms[own.front()].residue;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m.atoms[i].residue == residue || moves[i] || !is_heavy(m.atoms[i])) continue;
    if (norm(m.positions[i] - centre) < kReach_A) near.push_back(i);
  }
  return near;
}

bool has_charges(const std::vector<std::size_t>& atoms, const std::vector<float>& charges) {
  constexpr double kLeast = 0.05;
  double all = 0;
  for (const std::size_t i : atoms) all += std::fabs(static_cast<double>(charges[i]));
  return all > kLeast;
}

/// Whether a place of one side chain clashes with one of another.
bool pair_clashes(const Molecule& m, const SideChainPlacements& a, std::size_t of_a, const SideChainPlacements& b,
                  std::size_t of_b) {
  constexpr double kReach_A = 20;
  if (norm(a.positions[0][0] - b.positions[0][0]) > kReach_A) return false;
  for (std::size_t i = 0; i < a.atoms.size(); ++i) {
    if (!is_heavy(m.atoms[a.atoms[i]])) continue;
    for (std::size_t j = 0; j < b.atoms.size(); ++j) {
      if (is_heavy(m.atoms[b.atoms[j]]) &&
          clash(m.atoms[a.atoms[i]], a.positions[of_a][i], m.atoms[b.atoms[j]], b.positions[of_b][j]))
        return true;
    }
  }
  return false;
}

}  // namespace

std::vector<SideChainPlacements> side_chain_placements(const Molecule& molecule,
                                                       const std::vector<ResidueChange>& changes, bool of_target,
                                                       const std::vector<std::uint8_t>& may_move,
                                                       const std::vector<float>& charges) {
  const std::vector<std::vector<std::size_t>> residues = atoms_of_residues(molecule);
  struct Candidate {
    std::size_t change;
    const std::vector<std::size_t>* own;
    TurnedSideChain chain;
  };
  std::vector<Candidate> candidates;
  std::vector<bool> moves(molecule.size(), false);
  for (std::size_t c = 0; c < changes.size(); ++c) {
    const std::int32_t r = of_target ? changes[c].target : changes[c].source;
    const PlaceKnowledge& known = of_target ? changes[c].in_target : changes[c].in_source;
    if (r < 0 || may_move[c] == 0 || !(known.is_poor() || changes[c].kind == CauseKind::kSideChain)) continue;
    const std::vector<std::size_t>& own = residues[static_cast<std::size_t>(r)];
    const std::string& name = molecule.residues[static_cast<std::size_t>(r)].name;
    if (own.empty() || residue_letter(name) == 'C') continue;
    TurnedSideChain chain(molecule, own);
    if (!chain.can_turn() || !has_charges(chain.moving_atoms(), charges)) continue;
    for (const std::size_t i : chain.moving_atoms()) moves[i] = true;
    candidates.push_back({c, &own, std::move(chain)});
  }
  std::vector<SideChainPlacements> all;
  for (const Candidate& candidate : candidates) {
    SideChainPlacements placed{
        candidate.change, candidate.chain.moving_atoms(), {{}}, {candidate.chain.file_angles()}, 0};
    for (const std::size_t i : placed.atoms) placed.positions[0].push_back(molecule.positions[i]);
    const std::vector<std::size_t> nearby = fixed_neighbours(molecule, *candidate.own, moves);
    for (const std::vector<double>& angles : candidate.chain.grid()) {
      std::vector<Vec3d> places = candidate.chain.placed(angles);
      if (clashes(molecule, candidate.chain, *candidate.own, places, nearby)) {
        ++placed.n_refused;
      } else {
        placed.positions.push_back(std::move(places));
        placed.angles.push_back(angles);
      }
    }
    if (placed.positions.size() > 1) all.push_back(std::move(placed));
  }
  return all;
}

std::vector<std::vector<std::size_t>> draw_placements(const Molecule& molecule,
                                                      const std::vector<SideChainPlacements>& side_chains,
                                                      std::size_t n_draws, std::uint64_t seed, bool of_target) {
  std::vector<std::vector<std::size_t>> draws;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const std::uint64_t stream = 2 * draw + (of_target ? 1 : 0);
    std::vector<std::size_t> drawn;
    for (std::size_t s = 0; s < side_chains.size(); ++s) {
      const std::size_t n = side_chains[s].positions.size(), first = random_below(n, seed, stream, s);
      std::size_t chosen = 0;  // the file's, where all clash
      for (std::size_t tried = 0; tried < n; ++tried) {
        const std::size_t p = (first + tried) % n;
        bool good = true;
        for (std::size_t before = 0; before < s && good; ++before)
          good = !pair_clashes(molecule, side_chains[s], p, side_chains[before], drawn[before]);
        if (!good) continue;
        chosen = p;
        break;
      }
      drawn.push_back(chosen);
    }
    draws.push_back(std::move(drawn));
  }
  return draws;
}

}  // namespace espdiff
