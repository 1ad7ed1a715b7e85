// local_motions.cpp: fits from sums over residues, which a residue's neighbours add up, and screws that go on along the
// chain.
#include "compare/local_motions.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "align/superpose.h"
#include "base/vector.h"

namespace espdiff {
namespace {

/// Neighbours along the chain, and in space at both ends. With 4 places and 10 A the motions of neighbours differ so
/// much that a tenth of the surface of 1AAF tears; with 15 and 18 A less of it stays on its residue.
constexpr std::size_t kWindow = 8;
constexpr double kResidueReach_A = 12;
/// Added to the covariance: without neighbours, as for an ion, nothing says that a residue rotates.
constexpr double kResidueDamping_A2 = 50;
/// A chain is broken where the centres of successive residues lie farther apart. Nucleotides have up to 8 A.
constexpr double kLongestLink_A = 12;
constexpr double kTurn = 2 * kPi;

/// Sums over the paired atoms of residues, from which the best motion follows.
struct Moments {
  double n = 0;
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();

  void add(const Moments& other, double weight) {
    n += weight * other.n;
    start += weight * other.start;
    end += weight * other.end;
    product += weight * other.product;
  }
};

/// Falls from 1 to 0 at the limit.
double weight_at(double squared_share) {
  const double share = 1 - squared_share;
  return share > 0 ? share * share : 0;
}

RigidTransform best_motion(const Moments& sum) {
  const Eigen::Vector3d start = sum.start / sum.n, end = sum.end / sum.n;
  const Eigen::Matrix3d covariance =
      sum.product - sum.n * start * end.transpose() + kResidueDamping_A2 * Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixV().determinant() * svd.matrixU().determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  RigidTransform motion;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) motion.rotation[3 * row + column] = rotation(row, column);
  }
  const Eigen::Vector3d shift = end - rotation * start;
  motion.translation = {shift.x(), shift.y(), shift.z()};
  return motion;
}

struct ResidueNeighbourhoods {
  using Cell = std::array<int, 3>;

  const Molecule& source;
  std::vector<Moments> own;                          ///< [residue]
  std::vector<Eigen::Vector3d> start{}, end{};       ///< [residue] centres of the paired atoms
  std::map<Cell, std::vector<std::size_t>> cells{};  ///< of residues with paired atoms, by the start

  ResidueNeighbourhoods(const Molecule& molecule, std::vector<Moments> moments)
      : source(molecule), own(std::move(moments)) {
    for (std::size_t r = 0; r < own.size(); ++r) {
      const double n = std::max(own[r].n, 1.0);
      start.emplace_back(own[r].start / n);
      end.emplace_back(own[r].end / n);
      if (own[r].n > 0) cells[cell_of(start[r])].push_back(r);
    }
  }

  static Cell cell_of(const Eigen::Vector3d& p) {
    return {static_cast<int>(std::floor(p.x() / kResidueReach_A)),
            static_cast<int>(std::floor(p.y() / kResidueReach_A)),
            static_cast<int>(std::floor(p.z() / kResidueReach_A))};
  }

  /// Whether the chain goes on from the residue before.
  bool goes_on_to(std::size_t r) const {
    return r > 0 && own[r - 1].n > 0 && own[r].n > 0 && source.residues[r - 1].chain == source.residues[r].chain &&
           (start[r] - start[r - 1]).norm() < kLongestLink_A;
  }

  /// The first and the last residue of the window along the chain.
  std::pair<std::size_t, std::size_t> window_of(std::size_t r) const {
    std::size_t first = r, last = r;
    while (first > 0 && r - first < kWindow && goes_on_to(first)) --first;
    while (last + 1 < own.size() && last - r < kWindow && goes_on_to(last + 1)) ++last;
    return {first, last};
  }

  /// The residues around this one, ascending.
  std::vector<std::size_t> around(std::size_t r) const {
    const auto [first, last] = window_of(r);
    std::vector<std::size_t> found;
    for (std::size_t k = first; k <= last; ++k) found.push_back(k);
    const Cell c = cell_of(start[r]);
    for (int x = c[0] - 1; x <= c[0] + 1; ++x) {
      for (int y = c[1] - 1; y <= c[1] + 1; ++y) {
        for (int z = c[2] - 1; z <= c[2] + 1; ++z) {
          const auto cell = cells.find({x, y, z});
          if (cell != cells.end()) found.insert(found.end(), cell->second.begin(), cell->second.end());
        }
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  RigidTransform motion_of(std::size_t r) const {
    const auto [first, last] = window_of(r);
    Moments sum;
    for (const std::size_t k : around(r)) {
      const double far = std::max((start[k] - start[r]).squaredNorm(), (end[k] - end[r]).squaredNorm());
      double weight = weight_at(far / (kResidueReach_A * kResidueReach_A));
      if (k >= first && k <= last) {
        const double places = static_cast<double>(k > r ? k - r : r - k) / static_cast<double>(kWindow + 1);
        weight += weight_at(places * places);
      }
      if (weight > 0) sum.add(own[k], weight);
    }
    return best_motion(sum);
  }
};

/// The same motion the other way around, if that is closer to the rotation before.
Screw going_on(Screw screw, Vec3d before) {
  const Vec3d there = screw.angle * screw.axis - before, around = (screw.angle - kTurn) * screw.axis - before;
  if (screw.angle != 0 && dot(around, around) < dot(there, there)) screw.angle -= kTurn;
  return screw;
}

}  // namespace

DomainMotions local_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                            const RigidTransform& from_source, const RigidTransform& from_target) {
  std::vector<Moments> moments(source.residues.size());
  for (const auto& [s, t] : pairing.pairs) {
    const Vec3d p = from_source.apply(source.positions[s]), q = from_target.apply(target.positions[t]);
    const Eigen::Vector3d start(p.x, p.y, p.z), end(q.x, q.y, q.z);
    Moments& own = moments[static_cast<std::size_t>(source.atoms[s].residue)];
    own.n += 1;
    own.start += start;
    own.end += end;
    own.product += start * end.transpose();
  }
  const ResidueNeighbourhoods neighbourhoods(source, std::move(moments));
  DomainMotions result;
  result.of_residue.assign(source.residues.size(), -1);
  Vec3d rotation{};
  for (std::size_t r = 0; r < source.residues.size(); ++r) {
    if (!(neighbourhoods.own[r].n > 0)) continue;
    const RigidTransform motion = neighbourhoods.motion_of(r);
    const Screw screw = going_on(screw_of(motion), neighbourhoods.goes_on_to(r) ? rotation : Vec3d{});
    rotation = screw.angle * screw.axis;
    result.of_residue[r] = static_cast<std::int32_t>(result.motions.size());
    result.motions.push_back(motion);
    result.screws.push_back(screw);
  }
  return result;
}

}  // namespace espdiff
