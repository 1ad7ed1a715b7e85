// local_rotations.cpp: fits a rotation to each atom's neighbourhood, found by cells.
#include "motions/local_rotations.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "base/multiversion.h"

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

Cell cell_of(const Vec3d& p, double edge) {
  const auto place = [&](double x) { return static_cast<int>(std::floor(x / edge)); };
  return {place(p.x), place(p.y), place(p.z)};
}

/// [path] a number for its motion, equal where motions are.
std::vector<double> motion_numbers(const std::vector<MovingAtom>& paths) {
  std::map<std::array<double, 10>, double> known;
  std::vector<double> numbers;
  numbers.reserve(paths.size());
  std::array<double, 10> last{};
  for (const MovingAtom& path : paths) {
    const Screw& m = path.motion;
    const std::array<double, 10> motion{m.angle,     m.axis.x,    m.axis.y,  m.axis.z,  m.through.x,
                                        m.through.y, m.through.z, m.shift.x, m.shift.y, m.shift.z};
    const bool is_last = !numbers.empty() && motion == last;
    numbers.push_back(is_last ? numbers.back()
                              : known.emplace(motion, static_cast<double>(known.size())).first->second);
    last = motion;
  }
  return numbers;
}

/// Both ends of a path, without the motion of its domain.
struct Ends {
  double x, y, z, end_x, end_y, end_z, motion;
};

/// As wide as AVX2's vectors.
constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

/// Atoms near each other, one per lane, whose sums go through the same list of neighbours.
struct Group {
  std::size_t n = 0;
  std::size_t paths[kLanes] = {};
  double x[kLanes], y[kLanes], z[kLanes], end_x[kLanes], end_y[kLanes], end_z[kLanes], motion[kLanes];
  Vec3d low, high;  ///< the box of their starts
};

/// Of (1, a) and (1, b), the ways to a neighbour's start and end: the sum of weights, of both, and their products.
struct GroupSums {
  Lanes of[16];
};

/// Which atoms start within reach of a box, and a little beyond. @param out receives their numbers, in order
ESPDIFF_MULTIVERSION std::size_t near_box(const double* x, const double* y, const double* z, std::size_t begin,
                                          std::size_t end, const Group& group, std::uint32_t* out) {
  constexpr double kLargestSquare = 1.000001 * kAtomReach_A * kAtomReach_A;
  constexpr std::size_t kAtOnce = 64;
  double square[kAtOnce];
  std::size_t n_near = 0;
  for (std::size_t first = begin; first < end; first += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, end - first);
    for (std::size_t k = 0; k < n; ++k) {
      const double dx = std::max(std::max(group.low.x - x[first + k], x[first + k] - group.high.x), 0.0),
                   dy = std::max(std::max(group.low.y - y[first + k], y[first + k] - group.high.y), 0.0),
                   dz = std::max(std::max(group.low.z - z[first + k], z[first + k] - group.high.z), 0.0);
      square[k] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t k = 0; k < n; ++k) {
      out[n_near] = static_cast<std::uint32_t>(first + k);
      n_near += square[k] < kLargestSquare ? 1 : 0;
    }
  }
  return n_near;
}

/// Adds up what neighbours weigh, in their order: a lane that one does not reach adds zeros.
ESPDIFF_MULTIVERSION void sum_neighbours(const Ends* atoms, const std::uint32_t* near, std::size_t n_near,
                                         const Group& group, GroupSums& result) {
  Lanes sums[16] = {};
  for (std::size_t k = 0; k < n_near; ++k) {
    const Ends& atom = atoms[near[k]];
    struct {
      double a[3][kLanes], b[3][kLanes], weight[kLanes];
    } to;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      to.a[0][lane] = atom.x - group.x[lane];
      to.a[1][lane] = atom.y - group.y[lane];
      to.a[2][lane] = atom.z - group.z[lane];
      to.b[0][lane] = atom.end_x - group.end_x[lane];
      to.b[1][lane] = atom.end_y - group.end_y[lane];
      to.b[2][lane] = atom.end_z - group.end_z[lane];
      const double at_start =
                       to.a[0][lane] * to.a[0][lane] + to.a[1][lane] * to.a[1][lane] + to.a[2][lane] * to.a[2][lane],
                   at_end =
                       to.b[0][lane] * to.b[0][lane] + to.b[1][lane] * to.b[1][lane] + to.b[2][lane] * to.b[2][lane];
      const double share = 1 - std::max(at_start, at_end) / (kAtomReach_A * kAtomReach_A);
      const double of_same_motion = atom.motion == group.motion[lane] ? share : 0;
      to.weight[lane] = of_same_motion > 0 ? of_same_motion * of_same_motion : 0;
    }
    struct {
      Lanes a[3], b[3], weight;
    } lanes;
    static_assert(sizeof lanes == sizeof to);
    std::memcpy(&lanes, &to, sizeof lanes);
    const Lanes &w = lanes.weight, &bx = lanes.b[0], &by = lanes.b[1], &bz = lanes.b[2];
    const Lanes x = w * lanes.a[0], y = w * lanes.a[1], z = w * lanes.a[2];
    sums[0] += w;
    sums[1] += w * bx;
    sums[2] += w * by;
    sums[3] += w * bz;
    sums[4] += x;
    sums[5] += x * bx;
    sums[6] += x * by;
    sums[7] += x * bz;
    sums[8] += y;
    sums[9] += y * bx;
    sums[10] += y * by;
    sums[11] += y * bz;
    sums[12] += z;
    sums[13] += z * bx;
    sums[14] += z * by;
    sums[15] += z * bz;
  }
  for (std::size_t k = 0; k < 16; ++k) result.of[k] = sums[k];
}

/// The best-fit rotation, as axis times angle. @param sums [4][4] of GroupSums
Vec3d rotation_of(const Eigen::Matrix4d& sums) {
  const double all = sums(0, 0);
  if (all <= 0) return {};
  const Eigen::Vector3d sum_start = sums.col(0).tail<3>(), sum_end = sums.row(0).tail<3>().transpose();
  Eigen::Matrix3d covariance = sums.bottomRightCorner<3, 3>();
  covariance += kAtomDamping_A2 * Eigen::Matrix3d::Identity() - sum_start * sum_end.transpose() / all;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixV().determinant() * svd.matrixU().determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  return {vector.x(), vector.y(), vector.z()};
}

class AtomNeighbourhoods {
 public:
  explicit AtomNeighbourhoods(const std::vector<MovingAtom>& paths) {
    const std::vector<double> motions = motion_numbers(paths);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const Vec3d start = paths[i].start, end = start + paths[i].own_path();
      ends_.push_back({start.x, start.y, start.z, end.x, end.y, end.z, motions[i]});
      if (paths[i].at_start && paths[i].at_end) sorted_.emplace_back(cell_of(start, kAtomReach_A), i);
    }
    std::sort(sorted_.begin(), sorted_.end());
    for (const auto& [cell, i] : sorted_) {
      neighbours_.push_back(ends_[i]);
      x_.push_back(ends_[i].x);
      y_.push_back(ends_[i].y);
      z_.push_back(ends_[i].z);
    }
    group_by_place();
  }

  std::size_t n_groups() const { return (grouped_.size() + kLanes - 1) / kLanes; }

  /// Sets the rotations of a group's paths. @param near scratch memory
  void turn(std::size_t number, std::vector<std::uint32_t>& near, std::vector<MovingAtom>& paths) const {
    const Group group = group_of(number);
    GroupSums sums;
    sum_neighbours(neighbours_.data(), near.data(), find_near(group, near), group, sums);
    for (std::size_t lane = 0; lane < group.n; ++lane) {
      Eigen::Matrix4d of_path;
      for (int k = 0; k < 16; ++k) of_path(k / 4, k % 4) = sums.of[k][lane];
      paths[group.paths[lane]].own_rotation = rotation_of(of_path);
    }
  }

 private:
  /// Along a Morton curve through small cells: the box of a group of paths is small.
  void group_by_place() {
    constexpr double kEdge_A = 4;
    const auto spread = [](int place) {
      std::uint64_t bits = 0;
      for (unsigned k = 0; k < 21; ++k) bits |= (static_cast<std::uint64_t>(place + (1 << 20)) >> k & 1U) << 3 * k;
      return bits;
    };
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const auto [cx, cy, cz] = cell_of({ends_[i].x, ends_[i].y, ends_[i].z}, kEdge_A);
      grouped_.emplace_back(spread(cx) | spread(cy) << 1U | spread(cz) << 2U, i);
    }
    std::sort(grouped_.begin(), grouped_.end());
  }

  /// @param number of the group. Lanes beyond its last path repeat that
  Group group_of(std::size_t number) const {
    Group group;
    const std::size_t first = number * kLanes;
    group.n = std::min(kLanes, grouped_.size() - first);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = grouped_[first + std::min(lane, group.n - 1)].second;
      const Ends& ends = ends_[i];
      group.paths[lane] = i;
      group.x[lane] = ends.x;
      group.y[lane] = ends.y;
      group.z[lane] = ends.z;
      group.end_x[lane] = ends.end_x;
      group.end_y[lane] = ends.end_y;
      group.end_z[lane] = ends.end_z;
      group.motion[lane] = ends.motion;
    }
    const auto range = [](const double* of) { return std::minmax_element(of, of + kLanes); };
    const auto [low_x, high_x] = range(group.x);
    const auto [low_y, high_y] = range(group.y);
    const auto [low_z, high_z] = range(group.z);
    group.low = {*low_x, *low_y, *low_z};
    group.high = {*high_x, *high_y, *high_z};
    return group;
  }

  std::size_t first_of(const Cell& cell) const {
    const std::pair<Cell, std::size_t> least{cell, 0};
    return static_cast<std::size_t>(std::lower_bound(sorted_.begin(), sorted_.end(), least) - sorted_.begin());
  }

  /// @param near receives the atoms near the group, in their order  @returns how many
  std::size_t find_near(const Group& group, std::vector<std::uint32_t>& near) const {
    const Cell low = cell_of(group.low, kAtomReach_A), high = cell_of(group.high, kAtomReach_A);
    near.resize(neighbours_.size() + 1);
    std::size_t n = 0;
    for (int cx = low[0] - 1; cx <= high[0] + 1; ++cx) {
      for (int cy = low[1] - 1; cy <= high[1] + 1; ++cy) {
        // Cells that follow each other along z are one range of atoms.
        n += near_box(x_.data(), y_.data(), z_.data(), first_of({cx, cy, low[2] - 1}), first_of({cx, cy, high[2] + 2}),
                      group, near.data() + n);
      }
    }
    return n;
  }

  std::vector<Ends> ends_;  ///< [path]
  /// Paths of atoms that are present at both ends, sorted by the cells of their starts, then as they come.
  std::vector<std::pair<Cell, std::size_t>> sorted_;
  std::vector<Ends> neighbours_;                                ///< [sorted path]
  std::vector<double> x_, y_, z_;                               ///< [sorted path] the start
  std::vector<std::pair<std::uint64_t, std::size_t>> grouped_;  ///< all paths
};

}  // namespace

void set_local_rotations(std::vector<MovingAtom>& paths, const Progress& progress) {
  const AtomNeighbourhoods neighbourhoods(paths);
  // Each atom's is its own: the same bits at any number of threads. Between blocks there is time to be cancelled.
  constexpr std::ptrdiff_t kBlock = 512;
  const auto n = static_cast<std::ptrdiff_t>(neighbourhoods.n_groups());
  for (std::ptrdiff_t begin = 0; begin < n; begin += kBlock) {
    progress.check_cancelled();
    const std::ptrdiff_t end = std::min(begin + kBlock, n);
#pragma omp parallel
    {
      std::vector<std::uint32_t> near;
#pragma omp for schedule(dynamic, 8)
      for (std::ptrdiff_t group = begin; group < end; ++group)
        neighbourhoods.turn(static_cast<std::size_t>(group), near, paths);
    }
  }
}

}  // namespace espdiff
