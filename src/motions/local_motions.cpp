// local_motions.cpp: fits from sums over residues, which a residue's neighbours add up, and screws that continue along
// the chain.
#include "motions/local_motions.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "align/chain_links.h"
#include "align/geometry/superpose.h"
#include "base/vector.h"

namespace espdiff {
namespace {

/// Neighbours along the chain, and in space at both ends. With 4 places and 10 A the motions of neighbours differ so
/// much that a tenth of the surface of 1AAF tears; with 15 and 18 A less of it stays on its residue.
constexpr std::size_t kWindow = 8;
constexpr double kResidueReach_A = 12;
/// Added to the covariance: without neighbours, as for an ion, nothing says that a residue rotates.
constexpr double kResidueDamping_A2 = 50;
/// A chain is broken where the centres of linked residues lie farther apart. Nucleotides have up to 8 A.
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

  const ChainLinks& links;
  std::vector<Moments> own;                          ///< [residue]
  std::vector<Eigen::Vector3d> start{}, end{};       ///< [residue] centres of the paired atoms
  std::map<Cell, std::vector<std::size_t>> cells{};  ///< of residues with paired atoms, by the start

  ResidueNeighbourhoods(const ChainLinks& chains, std::vector<Moments> moments)
      : links(chains), own(std::move(moments)) {
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

  /// Whether the chain continues between two residues, one of which may be absent.
  bool goes_on(std::int32_t from, std::int32_t to) const {
    if (from < 0 || to < 0) return false;
    const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
    return own[a].n > 0 && own[b].n > 0 && (start[b] - start[a]).norm() < kLongestLink_A;
  }

  /// The residues around this one, each with its places along the chain from it; beyond the window kWindow + 1.
  std::map<std::size_t, std::size_t> around(std::size_t r) const {
    std::map<std::size_t, std::size_t> found{{r, 0}};
    for (const auto* way : {&links.next, &links.previous}) {
      auto at = static_cast<std::int32_t>(r);
      for (std::size_t places = 1; places <= kWindow; ++places) {
        const std::int32_t further = (*way)[static_cast<std::size_t>(at)];
        if (!goes_on(at, further)) break;
        at = further;
        found.try_emplace(static_cast<std::size_t>(at), places);
      }
    }
    const Cell c = cell_of(start[r]);
    for (int x = c[0] - 1; x <= c[0] + 1; ++x) {
      for (int y = c[1] - 1; y <= c[1] + 1; ++y) {
        for (int z = c[2] - 1; z <= c[2] + 1; ++z) {
          const auto cell = cells.find({x, y, z});
          if (cell == cells.end()) continue;
          for (const std::size_t k : cell->second) found.try_emplace(k, kWindow + 1);
        }
      }
    }
    return found;
  }

  RigidTransform motion_of(std::size_t r) const {
    Moments sum;
    for (const auto& [k, places] : around(r)) {
      const double far = std::max((start[k] - start[r]).squaredNorm(), (end[k] - end[r]).squaredNorm());
      const double along = static_cast<double>(places) / static_cast<double>(kWindow + 1);
      const double weight = weight_at(far / (kResidueReach_A * kResidueReach_A)) + weight_at(along * along);
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
  const ChainLinks links = chain_links(ResidueView(source));
  const ResidueNeighbourhoods neighbourhoods(links, std::move(moments));
  std::vector<std::pair<RigidTransform, Screw>> motions(source.residues.size());
  for (const std::vector<std::size_t>& chain : links.chains) {
    Vec3d rotation{};
    for (const std::size_t r : chain) {
      if (!(neighbourhoods.own[r].n > 0)) continue;
      const auto at = static_cast<std::int32_t>(r);
      const RigidTransform motion = neighbourhoods.motion_of(r);
      const bool goes_on = neighbourhoods.goes_on(links.previous[r], at);
      const Screw screw = going_on(screw_of(motion), goes_on ? rotation : Vec3d{});
      rotation = screw.angle * screw.axis;
      motions[r] = {motion, screw};
    }
  }
  DomainMotions result;
  result.of_residue.assign(source.residues.size(), -1);
  for (std::size_t r = 0; r < motions.size(); ++r) {
    if (!(neighbourhoods.own[r].n > 0)) continue;
    result.of_residue[r] = static_cast<std::int32_t>(result.motions.size());
    result.motions.push_back(motions[r].first);
    result.screws.push_back(motions[r].second);
  }
  return result;
}

}  // namespace espdiff
