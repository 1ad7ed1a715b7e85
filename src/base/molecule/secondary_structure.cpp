// secondary_structure.cpp: Kabsch and Sander's hydrogen bonds, turns and bridges.
#include "base/molecule/secondary_structure.h"

#include <array>
#include <cmath>

namespace espdiff {
namespace {

/// Acceptors of a residue's N-H: the residues whose C=O it binds, at most the best two (bifurcated bonds).
using Acceptors = std::array<int, 2>;

class HydrogenBonds {
 public:
  HydrogenBonds(const Molecule& molecule, const std::vector<Backbone>& backbone)
      : molecule_(molecule), backbone_(backbone), acceptors_(backbone.size(), {-1, -1}) {
    for (int i = 1; i < size(); ++i) find_acceptors(i);
  }

  int size() const { return static_cast<int>(backbone_.size()); }
  /// Whether the C=O of `acceptor` is bound to the N-H of `donor`; false beyond the ends.
  bool bond(int acceptor, int donor) const {
    if (acceptor < 0 || donor < 0 || acceptor >= size() || donor >= size()) return false;
    const Acceptors& found = acceptors_[static_cast<std::size_t>(donor)];
    return found[0] == acceptor || found[1] == acceptor;
  }

 private:
  const Backbone& at(int i) const { return backbone_[static_cast<std::size_t>(i)]; }
  Vec3d place(int atom) const { return molecule_.positions[static_cast<std::size_t>(atom)]; }

  void find_acceptors(int donor) {
    const Backbone& d = at(donor);
    const bool has_hydrogen = molecule_.residues[static_cast<std::size_t>(donor)].name != "PRO";
    if (!d.complete() || !at(donor - 1).complete() || !are_bound(molecule_, at(donor - 1), d) || !has_hydrogen) return;
    // The hydrogen lies opposite to the C=O of the previous peptide bond.
    const Vec3d carbonyl = place(at(donor - 1).o) - place(at(donor - 1).c);
    const Vec3d hydrogen = place(d.n) - (1.01 / norm(carbonyl)) * carbonyl;
    std::array<double, 2> best = {-0.5, -0.5};
    Acceptors& found = acceptors_[static_cast<std::size_t>(donor)];
    for (int i = 0; i < size(); ++i) {
      if (std::abs(i - donor) < 2 || !at(i).complete()) continue;
      if (norm(place(at(i).ca) - place(d.ca)) > 9) continue;
      const double energy = bond_energy(place(d.n), hydrogen, place(at(i).c), place(at(i).o));
      if (energy < best[0]) {
        best = {energy, best[0]};
        found = {i, found[0]};
      } else if (energy < best[1]) {
        best[1] = energy;
        found[1] = i;
      }
    }
  }

  /// kcal/mol.
  static double bond_energy(Vec3d n, Vec3d h, Vec3d c, Vec3d o) {
    return 0.084 * 332 * (1 / norm(o - n) + 1 / norm(c - h) - 1 / norm(o - h) - 1 / norm(c - n));
  }

  const Molecule& molecule_;
  const std::vector<Backbone>& backbone_;
  std::vector<Acceptors> acceptors_;
};

bool are_bridged(const HydrogenBonds& bonds, int i, int j, bool parallel) {
  if (parallel) return (bonds.bond(i - 1, j) && bonds.bond(j, i + 1)) || (bonds.bond(j - 1, i) && bonds.bond(i, j + 1));
  return (bonds.bond(i, j) && bonds.bond(j, i)) || (bonds.bond(i - 1, j + 1) && bonds.bond(j - 1, i + 1));
}

}  // namespace

std::vector<Backbone> backbone_of(const Molecule& molecule) {
  std::vector<Backbone> backbone(molecule.residues.size());
  for (std::size_t i = 0; i < molecule.atoms.size(); ++i) {
    const Atom& atom = molecule.atoms[i];
    Backbone& b = backbone[static_cast<std::size_t>(atom.residue)];
    const int index = static_cast<int>(i);
    if (atom.name == "N") b.n = index;
    // A calcium ion is also named CA.
    if (atom.name == "CA" && atom.element != "Ca") b.ca = index;
    if (atom.name == "C") b.c = index;
    if (atom.name == "O" || atom.name == "OT1" || atom.name == "O1") b.o = index;
  }
  return backbone;
}

bool are_bound(const Molecule& molecule, const Backbone& residue, const Backbone& next) {
  const auto distance = [&](int a, int b) {
    return norm(molecule.positions[static_cast<std::size_t>(a)] - molecule.positions[static_cast<std::size_t>(b)]);
  };
  if (residue.c >= 0 && next.n >= 0) return distance(residue.c, next.n) < 2;
  return residue.ca >= 0 && next.ca >= 0 && distance(residue.ca, next.ca) < 4.2;
}

std::vector<Fold> assign_folds(const Molecule& molecule, const std::vector<Backbone>& backbone) {
  const HydrogenBonds bonds(molecule, backbone);
  const int n = bonds.size();
  std::vector<Fold> folds(backbone.size(), Fold::kCoil);
  const auto set = [&](int i, Fold fold) { folds[static_cast<std::size_t>(i)] = fold; };
  for (int i = 1; i + 1 < n; ++i) {
    for (int j = i + 3; j + 1 < n; ++j) {
      for (const bool parallel : {true, false}) {
        if (!are_bridged(bonds, i, j, parallel)) continue;
        // A ladder: the next or the previous pair of residues is bridged in the same way.
        const int step = parallel ? 1 : -1;
        if (!are_bridged(bonds, i + 1, j + step, parallel) && !are_bridged(bonds, i - 1, j - step, parallel)) continue;
        set(i, Fold::kStrand);
        set(j, Fold::kStrand);
      }
    }
  }
  for (int i = 1; i + 4 < n; ++i) {
    if (!bonds.bond(i - 1, i + 3) || !bonds.bond(i, i + 4)) continue;
    for (int k = i; k < i + 4; ++k) set(k, Fold::kHelix);
  }
  // A single residue between two of a strand belongs to it: a bulge, or an edge strand in which every other residue is
  // bonded.
  for (int i = 1; i + 1 < n; ++i) {
    const auto at = [&](int k) { return folds[static_cast<std::size_t>(k)]; };
    if (at(i) == Fold::kCoil && at(i - 1) == Fold::kStrand && at(i + 1) == Fold::kStrand) set(i, Fold::kStrand);
  }
  return folds;
}

}  // namespace espdiff
