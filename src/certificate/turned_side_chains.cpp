// turned_side_chains.cpp: fits a rotation to the bonds of each atom of a side chain, one to its backbone, and one to
// the residues around it.
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
  std::string name{}, element{};
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

/// How the bonds of an atom turned, and where it went.
struct AtomTurn {
  Rotation rotation;
  Eigen::Vector3d end;
};

/// How the bonds at an atom turned: the way that is nearer to the backbone's.
struct BondTurn {
  Rotation rotation;
  bool is_named;  ///< whether each atom went to the place of its name, not to that of its equal
};

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

  /// How an atom's bonds rotated, the way that is nearer to the backbone's; empty where its bonds do not say.
  /// @param known [atom of the residue] of those around it, for the atoms that ask after it
  std::optional<AtomTurn> turn_of(const BothEnds& atom, const Rotation& backbone,
                                  std::vector<std::optional<BondTurn>>& known) const {
    const BothEnds* centre = &atom;
    std::vector<const BothEnds*> neighbours = heavy_neighbours(atom);
    if (neighbours.size() == 1) {
      centre = neighbours.front();
      if (centre->name == "CA") return std::nullopt;  // beta carbon of alanine, and its like
      neighbours = heavy_neighbours(*centre);
    }
    if (neighbours.size() < 2) return std::nullopt;
    std::optional<BondTurn>& turn = known[static_cast<std::size_t>(centre - atoms.data())];
    if (!turn) turn = bond_turn(*centre, neighbours, backbone);
    return AtomTurn{turn->rotation, turn->is_named ? atom.end : atom.exchanged};
  }

 private:
  static BondTurn bond_turn(const BothEnds& centre, const std::vector<const BothEnds*>& neighbours,
                            const Rotation& backbone) {
    Eigen::Matrix3d as_named = Eigen::Matrix3d::Zero(), exchanged = Eigen::Matrix3d::Zero();
    for (const BothEnds* b : neighbours) {
      as_named += (b->start - centre.start) * (b->end - centre.end).transpose();
      exchanged += (b->start - centre.start) * (b->exchanged - centre.exchanged).transpose();
    }
    const Rotation named_turn = kabsch(as_named);
    if (as_named == exchanged) return {named_turn, true};
    const Rotation exchanged_turn = kabsch(exchanged);
    const bool is_named = degrees_between(named_turn, backbone) <= degrees_between(exchanged_turn, backbone);
    return {is_named ? named_turn : exchanged_turn, is_named};
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

/// A rigid fit of places at both ends.
struct Fit {
  Rotation rotation;
  Eigen::Vector3d start, end;  ///< means

  Eigen::Vector3d carried(const Eigen::Vector3d& p) const { return end + rotation * (p - start); }
};

Fit fit_of(const std::vector<const BothEnds*>& atoms) {
  Fit fit{Rotation::Identity(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const auto n = static_cast<double>(atoms.size());
  for (const BothEnds* a : atoms) {
    fit.start += a->start / n;
    fit.end += a->end / n;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const BothEnds* a : atoms) covariance += (a->start - fit.start) * (a->end - fit.end).transpose();
  fit.rotation = kabsch(covariance);
  return fit;
}

std::vector<const BothEnds*> heavy_atoms(const PairedResidue& residue) {
  std::vector<const BothEnds*> heavy;
  for (const BothEnds& atom : residue.atoms) {
    if (!atom.light) heavy.push_back(&atom);
  }
  return heavy;
}

/// [residue] the fit of the CA around its own CA, or around the middle of a ligand; empty with fewer than
/// kLeastNeighbours.
std::vector<std::optional<Fit>> fits_around(const std::vector<PairedResidue>& residues) {
  constexpr double kSurroundings_A = 13;
  constexpr std::size_t kLeastNeighbours = 6;
  struct Trace {
    std::size_t residue;
    const BothEnds* ca;
    Eigen::Vector3d start;  // also here, since each residue looks at each
  };
  std::vector<Trace> traces;
  for (std::size_t r = 0; r < residues.size(); ++r) {
    if (const BothEnds* ca = residues[r].find("CA"); ca != nullptr) traces.push_back({r, ca, ca->start});
  }
  std::vector<std::optional<Fit>> fits(residues.size());
  const auto n = static_cast<std::ptrdiff_t>(residues.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t residue = 0; residue < n; ++residue) {
    const auto r = static_cast<std::size_t>(residue);
    const BothEnds* const ca = residues[r].find("CA");
    const std::vector<const BothEnds*> heavy = ca != nullptr ? std::vector{ca} : heavy_atoms(residues[r]);
    if (heavy.empty()) continue;
    const Fit middle = fit_of(heavy);
    std::vector<const BothEnds*> around;
    for (const Trace& other : traces) {
      constexpr double kLargestSquare = kSurroundings_A * kSurroundings_A;
      if ((other.start - middle.start).squaredNorm() > kLargestSquare || other.residue == r) continue;
      if ((other.ca->end - middle.end).squaredNorm() <= kLargestSquare) around.push_back(other.ca);
    }
    if (around.size() >= kLeastNeighbours) fits[r] = fit_of(around);
  }
  return fits;
}

/// Whether the atoms, carried by their surroundings, lie where atoms of the same elements are, whatever their names: a
/// ligand that half a turn maps onto itself.
bool lies_alike(const std::vector<const BothEnds*>& atoms, const Fit& around) {
  constexpr double kSamePlace_A = 1;
  return std::all_of(atoms.begin(), atoms.end(), [&](const BothEnds* a) {
    const Eigen::Vector3d place = around.carried(a->start);
    return std::any_of(atoms.begin(), atoms.end(), [&](const BothEnds* b) {
      return b->element == a->element && (b->end - place).norm() < kSamePlace_A;
    });
  });
}

/// p -> end + rotation * (p - start)
RigidTransform carried_by(const AtomTurn& turn, const Eigen::Vector3d& start) {
  RigidTransform carried;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) carried.rotation[3 * row + column] = turn.rotation(row, column);
  }
  const Eigen::Vector3d shift = turn.end - turn.rotation * start;
  carried.translation = {shift.x(), shift.y(), shift.z()};
  return carried;
}

/// Marks the atoms of a ligand that turned as a whole.
void mark_ligand(const PairedResidue& ligand, const Fit& around, std::vector<TurnedAtom>& turned) {
  constexpr std::size_t kLeastHeavyAtoms = 4;
  const std::vector<const BothEnds*> heavy = heavy_atoms(ligand);
  if (heavy.size() < kLeastHeavyAtoms) return;
  const Fit own = fit_of(heavy);
  if (degrees_between(own.rotation, around.rotation) <= kLeastTurnDegrees || lies_alike(heavy, around)) return;
  for (const BothEnds& atom : ligand.atoms)
    turned[atom.atom] = {Turn::kResidue, carried_by({own.rotation, atom.end}, atom.start)};
}

}  // namespace

std::vector<TurnedAtom> turned_atoms(const Molecule& source, const Molecule& target, const AtomPairing& pairing) {
  std::vector<PairedResidue> residues(source.residues.size());
  for (const auto& [s, t] : pairing.pairs) {
    const Atom& atom = source.atoms[s];
    const Vec3d &p = source.positions[s], &q = target.positions[t];
    residues[static_cast<std::size_t>(atom.residue)].atoms.push_back(
        {s, atom.name, atom.element, is_light_atom(atom), {p.x, p.y, p.z}, {q.x, q.y, q.z}, {}});
  }
  const std::vector<std::optional<Fit>> around = fits_around(residues);
  std::vector<TurnedAtom> turned(source.size());
  const auto n = static_cast<std::ptrdiff_t>(residues.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::ptrdiff_t residue = 0; residue < n; ++residue) {
    const auto r = static_cast<std::size_t>(residue);
    const std::optional<Rotation> backbone = residues[r].of_backbone();
    if (!backbone) {
      if (around[r]) mark_ligand(residues[r], *around[r], turned);
      continue;
    }
    note_exchanges(residue_letter(source.residues[r].name), residues[r]);
    const bool is_whole = around[r] && degrees_between(*backbone, around[r]->rotation) > kLeastTurnDegrees;
    std::vector<std::optional<BondTurn>> known(residues[r].atoms.size());
    for (const BothEnds& atom : residues[r].atoms) {
      const std::optional<AtomTurn> of_bonds =
          is_of_backbone(atom.name) ? std::nullopt : residues[r].turn_of(atom, *backbone, known);
      const bool is_side_chain = of_bonds && degrees_between(of_bonds->rotation, *backbone) > kLeastTurnDegrees;
      if (!is_whole && !is_side_chain) continue;
      turned[atom.atom] = {is_whole ? Turn::kResidue : Turn::kSideChain,
                           carried_by(of_bonds.value_or(AtomTurn{*backbone, atom.end}), atom.start)};
    }
  }
  return turned;
}

}  // namespace espdiff
