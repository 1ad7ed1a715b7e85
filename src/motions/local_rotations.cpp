// local_rotations.cpp: fits a rotation to each atom's neighbourhood, found by cells.
#include "motions/local_rotations.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace espdiff {
namespace {

/// Atoms farther apart than this at either end are not neighbours.
constexpr double kAtomReach_A = 12;
/// Added to the covariance. Damps rotations that few neighbours support: loops that move on their own, few atoms,
/// collinear atoms. A neighbourhood inside a protein has about 2600 along each axis, at the surface about half. Less
/// damping keeps more of the surface on its residue but tears more of it between neighbourhoods; see
/// bench/study_notes.md.
constexpr double kAtomDamping_A2 = 300;

using Cell = std::array<int, 3>;

Eigen::Vector3d to_eigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

bool same_motion(const Screw& a, const Screw& b) {
  const Vec3d axis = a.axis - b.axis, through = a.through - b.through, shift = a.shift - b.shift;
  return a.angle == b.angle && dot(axis, axis) + dot(through, through) + dot(shift, shift) == 0;
}

Cell cell_of(const Eigen::Vector3d& p) {
  return {static_cast<int>(std::floor(p.x() / kAtomReach_A)), static_cast<int>(std::floor(p.y() / kAtomReach_A)),
          static_cast<int>(std::floor(p.z() / kAtomReach_A))};
}

/// Both ends of all paths, without the motions of their domains.
struct AtomNeighbourhoods {
  const std::vector<MovingAtom>& paths;
  std::vector<Eigen::Vector3d> start{}, end{};
  /// Atoms that are present at both ends, sorted by the cells of their starts, then as they come.
  std::vector<std::pair<Cell, std::size_t>> sorted{};
  std::vector<double> x{}, y{}, z{};  ///< [sorted atom] the start

  explicit AtomNeighbourhoods(const std::vector<MovingAtom>& all) : paths(all) {
    for (std::size_t i = 0; i < paths.size(); ++i) {
      start.push_back(to_eigen(paths[i].start));
      end.push_back(to_eigen(paths[i].start + paths[i].own_path()));
      if (paths[i].at_start && paths[i].at_end) sorted.emplace_back(cell_of(start[i]), i);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [cell, i] : sorted) {
      x.push_back(start[i].x());
      y.push_back(start[i].y());
      z.push_back(start[i].z());
    }
  }

  std::size_t first_of(const Cell& cell) const {
    const std::pair<Cell, std::size_t> least{cell, 0};
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), least) - sorted.begin());
  }

  /// Visits the atoms that start within reach, and a little more.
  template <typename Visit>
  void visit(std::size_t i, Visit visit) const {
    constexpr std::size_t kAtOnce = 64;
    constexpr double kLargestSquare = 1.000001 * kAtomReach_A * kAtomReach_A;
    const Cell c = cell_of(start[i]);
    const double from_x = start[i].x(), from_y = start[i].y(), from_z = start[i].z();
    for (int cx = c[0] - 1; cx <= c[0] + 1; ++cx) {
      for (int cy = c[1] - 1; cy <= c[1] + 1; ++cy) {
        // Cells that follow each other along z are one range of atoms.
        const std::size_t after = first_of({cx, cy, c[2] + 2});
        for (std::size_t begin = first_of({cx, cy, c[2] - 1}); begin < after; begin += kAtOnce) {
          const std::size_t n = std::min(kAtOnce, after - begin);
          double square[kAtOnce];
          for (std::size_t k = 0; k < n; ++k) {
            const double dx = x[begin + k] - from_x, dy = y[begin + k] - from_y, dz = z[begin + k] - from_z;
            square[k] = dx * dx + dy * dy + dz * dz;
          }
          for (std::size_t k = 0; k < n; ++k) {
            if (square[k] < kLargestSquare) visit(sorted[begin + k].second);
          }
        }
      }
    }
  }

  Vec3d turn(std::size_t i) const {
    // Of (1, a) and (1, b): the sum of weights, of both ends, and the covariance, as one matrix of whole vectors.
    Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
    visit(i, [&](std::size_t j) {
      const Eigen::Vector3d a = start[j] - start[i], b = end[j] - end[i];
      const double share = 1 - std::max(a.squaredNorm(), b.squaredNorm()) / (kAtomReach_A * kAtomReach_A);
      if (share <= 0 || !same_motion(paths[i].motion, paths[j].motion)) return;
      const double weight = share * share;
      const Eigen::Vector4d from = weight * Eigen::Vector4d(1, a.x(), a.y(), a.z()), to(1, b.x(), b.y(), b.z());
      sums.noalias() += from * to.transpose();
    });
    const double all = sums(0, 0);
    if (all <= 0) return {};
    const Eigen::Vector3d sum_start = sums.col(0).tail<3>(), sum_end = sums.row(0).tail<3>().transpose();
    Eigen::Matrix3d covariance = sums.bottomRightCorner<3, 3>();
    covariance += kAtomDamping_A2 * Eigen::Matrix3d::Identity() - sum_start * sum_end.transpose() / all;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = svd.matrixV().determinant() * svd.matrixU().determinant() < 0 ? -1.0 : 1.0;
    const Eigen::Matrix3d rotation =
        svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
    const Eigen::AngleAxisd turn(rotation);
    const Eigen::Vector3d vector = turn.angle() * turn.axis();
    return {vector.x(), vector.y(), vector.z()};
  }
};

}  // namespace

void set_local_rotations(std::vector<MovingAtom>& paths, const Progress& progress) {
  const AtomNeighbourhoods neighbourhoods(paths);
  // Each atom's is its own: the same bits at any number of threads. Between blocks there is time to be cancelled.
  constexpr std::ptrdiff_t kBlock = 4096;
  const auto n = static_cast<std::ptrdiff_t>(paths.size());
  for (std::ptrdiff_t begin = 0; begin < n; begin += kBlock) {
    progress.check_cancelled();
    const std::ptrdiff_t end = std::min(begin + kBlock, n);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const auto atom = static_cast<std::size_t>(i);
      paths[atom].own_rotation = neighbourhoods.turn(atom);
    }
  }
}

}  // namespace espdiff
