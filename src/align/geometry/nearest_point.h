// nearest_point.h: the nearest of many points, by a tree.
#pragma once

#include <cstddef>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A k-d tree (Bentley, Commun. ACM 18, 509 (1975)) over points that are split at their median along the widest axis.
/// Building takes O(n log n), a search O(log n) on average.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Vec3d> points);

  /// The number of the point nearest to `p`; of several as near the first. @pre there are points
  std::size_t operator()(const Vec3d& p) const;

 private:
  struct Best {
    double square;
    std::size_t point;
  };
  void split(std::size_t begin, std::size_t end);
  int widest_axis(std::size_t begin, std::size_t end) const;
  void look(std::size_t begin, std::size_t end, const Vec3d& p, Best& best) const;

  std::vector<Vec3d> points_;
  std::vector<std::size_t> order_;  ///< the middle of each part parts it; the halves are parts again
  std::vector<int> axis_;           ///< [position in order_] along which the part is split
};

}  // namespace espdiff
