// place_hydrogens.cpp: directions of bonds by geometry, and the choice of rotations about single bonds.
#include "prepare/charges/place_hydrogens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace espdiff {
namespace {

constexpr double kClash_A = 1.6, kHydrogenBond_A = 2.5;
const double kTetrahedralAngle = std::acos(-1.0 / 3), kTrigonalAngle = 2 * kPi / 3;

enum class Shape { kTetrahedral, kTrigonal, kLinear };

Shape shape_of(const std::string& type) {
  const std::string kind = type.substr(std::min(type.size(), type.find('.')));
  if (kind == ".1") return Shape::kLinear;
  for (const char* trigonal : {".2", ".ar", ".am", ".pl3", ".cat", ".co2"}) {
    if (kind == trigonal) return Shape::kTrigonal;
  }
  return Shape::kTetrahedral;
}

double length_of_bond(const Mol2Atom& heavy) {
  const Shape shape = shape_of(heavy.type);
  if (heavy.element == "C") return shape == Shape::kTetrahedral ? 1.09 : shape == Shape::kTrigonal ? 1.08 : 1.06;
  if (heavy.element == "N") return 1.01;
  if (heavy.element == "O") return 0.97;
  if (heavy.element == "S") return 1.34;
  if (heavy.element == "P") return 1.42;
  if (heavy.element == "B") return 1.19;
  return 1.48;  // silicon, selenium
}

bool is_hydrogen(const std::string& element) { return element == "H" || element == "D"; }

Vec3d unit(const Vec3d& v) {
  const double length = norm(v);
  return length > 0 ? 1 / length * v : v;
}

/// A unit vector perpendicular to a unit vector.
Vec3d any_perpendicular(const Vec3d& u) {
  const Vec3d axis = std::fabs(u.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return unit(axis - dot(axis, u) * u);
}

using Directions = std::vector<Vec3d>;

/// Opposite to the sum of the bonds; perpendicular to them where they lie in a plane.
Vec3d opposite(const Directions& bonds) {
  constexpr double kFlat = 0.1;
  Vec3d sum{};
  for (const Vec3d& u : bonds) sum += u;
  if (norm(sum) > kFlat) return unit(-1.0 * sum);
  const Vec3d normal = bonds.size() > 2 ? cross(bonds[0], bonds[1]) : Vec3d{};
  return norm(normal) > kFlat ? unit(normal) : any_perpendicular(bonds[0]);
}

/// Atoms without hydrogens yet, such as an amide's nitrogen, keep a hydrogen farther away than oxygens and hydrogens
/// do.
constexpr double kHeavyMargin_A = 0.7;

struct Obstacle {
  Vec3d position;
  bool accepts = false;  ///< hydrogen bonds
  double margin_A;       ///< subtracted from distances
  std::size_t atom;      ///< of the ligand; its number of atoms for others
};

class HydrogenPlacer {
 public:
  HydrogenPlacer(const Mol2File& ligand, const std::vector<Mol2Bond>& bonds, std::size_t n_given,
                 const Molecule& surroundings)
      : atoms_(ligand.atoms), n_given_(n_given), bound_(ligand.atoms.size()) {
    for (const Mol2Bond& bond : bonds) {
      bound_[bond.a].push_back(bond.b);
      bound_[bond.b].push_back(bond.a);
    }
    for (std::vector<std::size_t>& neighbours : bound_) std::sort(neighbours.begin(), neighbours.end());
    for (std::size_t i = 0; i < n_given; ++i) add_obstacle(atoms_[i].position, atoms_[i].element, i);
    add_surroundings(surroundings);
  }

  std::vector<Vec3d> places() {
    std::vector<std::size_t> order(n_given_);
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Atoms whose hydrogens follow from heavy atoms come first, rotations that look at others last.
    const auto freedom = [&](std::size_t x) {
      if (placed_neighbours(x).size() != 1) return 0;
      return hydrogens_of(x).size() > 1 ? 1 : 2;
    };
    std::vector<int> rank;
    for (const std::size_t x : order) rank.push_back(freedom(x));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
    for (const std::size_t x : order) place_at(x);
    std::vector<Vec3d> places;
    for (std::size_t i = n_given_; i < atoms_.size(); ++i) places.push_back(atoms_[i].position);
    return places;
  }

 private:
  void add_obstacle(const Vec3d& position, const std::string& element, std::size_t atom) {
    const bool accepts = element == "O";
    obstacles_.push_back({position, accepts, accepts || is_hydrogen(element) ? 0 : kHeavyMargin_A, atom});
  }

  /// Heavy atoms of other residues that a hydrogen could meet, and those that are bound.
  void add_surroundings(const Molecule& molecule) {
    constexpr double kReach_A = 6, kSame_A = 0.05;
    for (std::size_t j = 0; j < molecule.size(); ++j) {
      if (is_hydrogen(molecule.atoms[j].element)) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < n_given_; ++i)
        nearest = std::min(nearest, norm(molecule.positions[j] - atoms_[i].position));
      if (nearest < kSame_A || nearest > kReach_A) continue;
      add_obstacle(molecule.positions[j], molecule.atoms[j].element, atoms_.size());
      others_.push_back(molecule.atoms[j].element);
    }
  }

  std::vector<std::size_t> hydrogens_of(std::size_t x) const {
    std::vector<std::size_t> hydrogens;
    for (const std::size_t i : bound_[x]) {
      if (i >= n_given_) hydrogens.push_back(i);
    }
    return hydrogens;
  }

  bool is_placed(std::size_t i) const {
    return i < n_given_ ||
           std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& o) { return o.atom == i; });
  }

  std::vector<std::size_t> placed_neighbours(std::size_t x) const {
    std::vector<std::size_t> neighbours;
    for (const std::size_t i : bound_[x]) {
      if (is_placed(i)) neighbours.push_back(i);
    }
    return neighbours;
  }

  void put(std::size_t hydrogen, std::size_t x, const Vec3d& direction) {
    atoms_[hydrogen].position = atoms_[x].position + length_of_bond(atoms_[x]) * direction;
    add_obstacle(atoms_[hydrogen].position, atoms_[hydrogen].element, hydrogen);
  }

  /// Directions to atoms of other residues that are bound; metals are not.
  Directions bonds_to_others(std::size_t x) const {
    constexpr double kBond_A = 1.85, kLongBond_A = 2.25;
    const auto is_large = [](const std::string& element) {
      return element == "S" || element == "P" || element == "SE";
    };
    Directions directions;
    for (std::size_t k = 0; k < others_.size(); ++k) {
      const Vec3d to_other = obstacles_[n_given_ + k].position - atoms_[x].position;
      const bool is_bonding = is_large(others_[k]) || others_[k] == "C" || others_[k] == "N" || others_[k] == "O";
      const double limit = is_large(others_[k]) || is_large(atoms_[x].element) ? kLongBond_A : kBond_A;
      if (is_bonding && norm(to_other) < limit) directions.push_back(unit(to_other));
    }
    return directions;
  }

  void place_at(std::size_t x) {
    std::vector<std::size_t> hydrogens = hydrogens_of(x);
    if (hydrogens.empty()) return;
    const std::vector<std::size_t> neighbours = placed_neighbours(x);
    Directions bonds;
    for (const std::size_t i : neighbours) bonds.push_back(unit(atoms_[i].position - atoms_[x].position));
    for (const Vec3d& direction : bonds_to_others(x)) {
      if (hydrogens.empty()) return;
      put(hydrogens.front(), x, direction);
      hydrogens.erase(hydrogens.begin());
      bonds.push_back(direction);
    }
    if (hydrogens.empty()) return;
    const Directions chosen = bonds.size() == 1 && neighbours.size() == 1 ? rotated(x, neighbours[0], hydrogens.size())
                                                                          : fixed(x, bonds, hydrogens.size());
    for (std::size_t h = 0; h < hydrogens.size(); ++h) put(hydrogens[h], x, chosen[std::min(h, chosen.size() - 1)]);
  }

  /// Directions that follow from the bonds, but for the side of a single hydrogen of an amine.
  Directions fixed(std::size_t x, const Directions& bonds, std::size_t n) const {
    if (bonds.size() < 2) {
      const Vec3d first = bonds.empty() ? unit({1, 1, 1}) : -1.0 * bonds[0];
      return {first, unit({-1, -1, 1}), unit({-1, 1, -1}), unit({1, -1, -1})};
    }
    const Vec3d middle = opposite(bonds);
    if (bonds.size() > 2 || (n == 1 && shape_of(atoms_[x].type) != Shape::kTetrahedral)) return {middle};
    const Vec3d across = cross(bonds[0], bonds[1]);
    const Vec3d normal = norm(across) > 0.1 ? unit(across) : unit(cross(middle, bonds[0]));
    const double half = kTetrahedralAngle / 2;
    const Vec3d up = std::cos(half) * middle + std::sin(half) * normal,
                down = std::cos(half) * middle - std::sin(half) * normal;
    if (n > 1) return {up, down};
    return best(x, {{up}, {down}});
  }

  /// Directions of n hydrogens of an atom with one neighbour, which they can be rotated about.
  Directions rotated(std::size_t x, std::size_t y, std::size_t n) const {
    const Shape shape = shape_of(atoms_[x].type);
    const Vec3d to_y = unit(atoms_[y].position - atoms_[x].position);
    if (shape == Shape::kLinear) return {-1.0 * to_y};
    const bool is_trigonal = shape == Shape::kTrigonal && n < 3;
    const double angle = is_trigonal ? kTrigonalAngle : kTetrahedralAngle;
    const Vec3d e1 = reference(x, y, to_y), e2 = cross(to_y, e1);
    const auto at = [&](std::initializer_list<double> degrees, double turn) {
      Directions directions;
      for (const double degree : degrees) {
        const double torsion = (degree + turn) * kPi / 180;
        directions.push_back(std::cos(angle) * to_y +
                             std::sin(angle) * (std::cos(torsion) * e1 + std::sin(torsion) * e2));
      }
      return directions;
    };
    if (is_trigonal && n == 2) return at({0, 180}, 0);
    std::vector<Directions> preferred;
    if (n >= 3) preferred = {at({180, 300, 60}, 0)};
    if (n == 2) preferred = {at({180, 300}, 0), at({180, 60}, 0), at({60, 300}, 0)};
    if (n == 1) preferred = {at({180}, 0), at({60}, 0), at({300}, 0)};
    if (n == 1 && (is_trigonal || shape_of(atoms_[y].type) == Shape::kTrigonal)) preferred = {at({180}, 0), at({0}, 0)};
    Directions chosen = best(x, preferred);
    if (is_trigonal || nearest(x, chosen, false) >= kClash_A) return chosen;
    std::vector<Directions> all = {chosen};
    constexpr double kStep = 15, kTurn = 360;
    for (double turn = kStep; turn < kTurn; turn += kStep)
      all.push_back(n >= 3 ? at({180, 300, 60}, turn) : n == 2 ? at({180, 300}, turn) : at({180}, turn));
    return best(x, all);
  }

  /// Perpendicular to the bond from x to y, towards another neighbour of y.
  Vec3d reference(std::size_t x, std::size_t y, const Vec3d& to_y) const {
    constexpr double kCollinear = 0.1;
    for (const std::size_t i : placed_neighbours(y)) {
      if (i == x) continue;
      const Vec3d u = unit(atoms_[i].position - atoms_[y].position);
      const Vec3d across = u - dot(u, to_y) * to_y;
      if (norm(across) > kCollinear) return unit(across);
    }
    return any_perpendicular(to_y);
  }

  /// Distance from the hydrogens to the nearest atom that is not bound to theirs, less its margin.
  double nearest(std::size_t x, const Directions& directions, bool acceptors_only) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& direction : directions) {
      const Vec3d place = atoms_[x].position + length_of_bond(atoms_[x]) * direction;
      for (const Obstacle& obstacle : obstacles_) {
        const bool is_own = obstacle.atom == x || std::count(bound_[x].begin(), bound_[x].end(), obstacle.atom) > 0;
        if (!is_own && (obstacle.accepts || !acceptors_only))
          least = std::min(least, norm(obstacle.position - place) - obstacle.margin_A);
      }
    }
    return least;
  }

  /// The first of the best; differences of less than 0.01 Angstrom do not count.
  Directions best(std::size_t x, const std::vector<Directions>& choices) const {
    constexpr double kAlike_A = 0.01, kBeforeOthers = 100;
    const bool is_polar = atoms_[x].element != "C";
    std::size_t chosen = 0;
    double best_score = -std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < choices.size(); ++c) {
      const double gap = nearest(x, choices[c], false), bond = is_polar ? nearest(x, choices[c], true) : kBeforeOthers;
      const double score = gap < kClash_A           ? gap - kBeforeOthers
                           : bond < kHydrogenBond_A ? kBeforeOthers - bond
                                                    : std::min(gap, kBeforeOthers / 2);
      if (score <= best_score + kAlike_A) continue;
      best_score = score;
      chosen = c;
    }
    return choices[chosen];
  }

  std::vector<Mol2Atom> atoms_;
  std::size_t n_given_;
  std::vector<std::vector<std::size_t>> bound_;  ///< [atom] its neighbours, in order
  std::vector<Obstacle> obstacles_;              ///< given atoms, others, hydrogens
  std::vector<std::string> others_;              ///< elements of the obstacles of other residues
};

}  // namespace

void drop_impossible_hydrogens(Mol2File& ligand, std::vector<Mol2Bond>& bonds, std::size_t n_given) {
  const auto most = [](const std::string& element) {
    return element == "C" || element == "N" ? std::size_t{4} : element == "O" ? std::size_t{2} : std::size_t{8};
  };
  std::vector<std::size_t> n_bonds(ligand.atoms.size(), 0);
  std::vector<bool> keep(ligand.atoms.size(), true);
  // Bonds of given atoms count first, wherever they stand in the file.
  for (const bool of_hydrogens : {false, true}) {
    for (const Mol2Bond& bond : bonds) {
      const std::size_t heavy = std::min(bond.a, bond.b), other = std::max(bond.a, bond.b);
      if ((other >= n_given) != of_hydrogens) continue;
      keep[other] = !of_hydrogens || n_bonds[heavy] < most(ligand.atoms[heavy].element);
      if (!keep[other]) ligand.atoms[heavy].charge += ligand.atoms[other].charge;
      ++n_bonds[heavy];
      ++n_bonds[other];
    }
  }
  std::vector<std::size_t> place(ligand.atoms.size(), 0);
  std::vector<Mol2Atom> kept;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    place[i] = kept.size();
    if (keep[i]) kept.push_back(ligand.atoms[i]);
  }
  ligand.atoms = std::move(kept);
  std::vector<Mol2Bond> kept_bonds;
  for (const Mol2Bond& bond : bonds) {
    if (keep[bond.a] && keep[bond.b]) kept_bonds.push_back({place[bond.a], place[bond.b]});
  }
  bonds = std::move(kept_bonds);
}

std::vector<Vec3d> place_hydrogens(const Mol2File& ligand, const std::vector<Mol2Bond>& bonds, std::size_t n_given,
                                   const Molecule& surroundings) {
  return HydrogenPlacer(ligand, bonds, n_given, surroundings).places();
}

}  // namespace espdiff
