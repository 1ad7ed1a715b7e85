// turned_side_chains.cpp: fits a rotation to the bonds of each atom of a side chain, and one to its backbone.
#include "certificate/turned_side_chains.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "align/residue_names.h"

namespace espdiff {
namespace {

/// Heavy atoms of a residue farther apart are not bonded: C-S bonds have 1.82 A, C-Se 1.95 A.
constexpr double kLongestBond_A = 2.05;

/// Atoms that half a turn exchanges, by one-letter code.
constexpr std::pair<char, std::array<const char*, 2>> kEqualAtoms[] = {
    {'D', {"OD1", "OD2"}}, {'E', {"OE1", "OE2"}}, {'F', {"CD1", "CD2"}}, {'F', {"CE1", "CE2"}},
    {'Y', {"CD1", "CD2"}}, {'Y', {"CE1", "CE2"}}, {'R', {"NH1", "NH2"}}};

bool is_light_atom(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

/// A paired atom of a residue at both ends.
struct BothEnds {
  std::size_t atom = 0;  ///< of the source
  std::string name{};
  bool light = false;
  Eigen::Vector3d start, end;
  Eigen::Vector3d exchanged;  ///< the end of the atom that half a turn puts into its place; its own without one
};

using Rotation = Eigen::Matrix3d;

Rotation kabsch(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixV().determinant() * svd.matrixU().determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
}

double degrees_between(const Rotation& a, const Rotation& b) {
  constexpr double kDegrees = 180 / kPi;
  return kDegrees * std::fabs(Eigen::AngleAxisd(a * b.transpose()).angle());
}

/// The paired atoms of one residue.
struct PairedResidue {
  std::vector<BothEnds> atoms{};

  const BothEnds* find(const char* name) const {
    const auto found = std::find_if(atoms.begin(), atoms.end(), [&](const BothEnds& a) { return a.name == name; });
    return found == atoms.end() ? nullptr : &*found;
  }

  std::optional<Rotation> of_backbone() const {
    const BothEnds *n = find("N"), *ca = find("CA"), *c = find("C");
    if (n == nullptr || ca == nullptr || c == nullptr) return std::nullopt;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const BothEnds* other : {n, c}) covariance += (other->start - ca->start) * (other->end - ca->end).transpose();
    return kabsch(covariance);
  }

  std::vector<const BothEnds*> heavy_neighbours(const BothEnds& a) const {
    std::vector<const BothEnds*> found;
    for (const BothEnds& b : atoms) {
      if (&a != &b && !b.light && (a.start - b.start).norm() < kLongestBond_A &&
          (a.end - b.end).norm() < kLongestBond_A)
        found.push_back(&b);
    }
    return found;
  }

  /// By how much an atom's bonds rotated against the backbone, degrees; empty where its bonds do not say.
  std::optional<double> turn_of(const BothEnds& atom, const Rotation& backbone) const {
    const BothEnds* centre = &atom;
    std::vector<const BothEnds*> neighbours = heavy_neighbours(atom);
    if (neighbours.size() == 1) {
      centre = neighbours.front();
      if (centre->name == "CA") return std::nullopt;  // beta carbon of alanine, and its like
      neighbours = heavy_neighbours(*centre);
    }
    if (neighbours.size() < 2) return std::nullopt;
    Eigen::Matrix3d as_named = Eigen::Matrix3d::Zero(), exchanged = Eigen::Matrix3d::Zero();
    for (const BothEnds* b : neighbours) {
      as_named += (b->start - centre->start) * (b->end - centre->end).transpose();
      exchanged += (b->start - centre->start) * (b->exchanged - centre->exchanged).transpose();
    }
    return std::min(degrees_between(kabsch(as_named), backbone), degrees_between(kabsch(exchanged), backbone));
  }
};

void note_exchanges(char letter, PairedResidue& residue) {
  for (BothEnds& atom : residue.atoms) atom.exchanged = atom.end;
  for (const auto& [of, names] : kEqualAtoms) {
    const BothEnds *one = residue.find(names[0]), *other = residue.find(names[1]);
    if (of != letter || one == nullptr || other == nullptr) continue;
    const Eigen::Vector3d end_of_one = one->end, end_of_other = other->end;
    residue.atoms[static_cast<std::size_t>(one - residue.atoms.data())].exchanged = end_of_other;
    residue.atoms[static_cast<std::size_t>(other - residue.atoms.data())].exchanged = end_of_one;
  }
}

bool is_of_backbone(const std::string& name) {
  return name == "N" || name == "CA" || name == "C" || name == "O" || name == "OXT";
}

}  // namespace

std::vector<std::uint8_t> turned_atoms(const Molecule& source, const Molecule& target, const AtomPairing& pairing) {
  std::vector<PairedResidue> residues(source.residues.size());
  for (const auto& [s, t] : pairing.pairs) {
    const Atom& atom = source.atoms[s];
    const Vec3d &p = source.positions[s], &q = target.positions[t];
    residues[static_cast<std::size_t>(atom.residue)].atoms.push_back(
        {s, atom.name, is_light_atom(atom), {p.x, p.y, p.z}, {q.x, q.y, q.z}, {}});
  }
  std::vector<std::uint8_t> turned(source.size(), 0);
  for (std::size_t r = 0; r < residues.size(); ++r) {
    const std::optional<Rotation> backbone = residues[r].of_backbone();
    if (!backbone) continue;
    note_exchanges(residue_letter(source.residues[r].name), residues[r]);
    for (const BothEnds& atom : residues[r].atoms) {
      if (is_of_backbone(atom.name)) continue;
      const std::optional<double> turn = residues[r].turn_of(atom, *backbone);
      turned[atom.atom] = turn && *turn > kLeastTurnDegrees ? 1 : 0;
    }
  }
  return turned;
}

}  // namespace espdiff
