// nearest_point.cpp: building the tree, and looking into it.
#include "align/geometry/nearest_point.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace espdiff {

NearestPoint::NearestPoint(std::vector<Vec3d> points)
    : points_(std::move(points)), order_(points_.size()), axis_(points_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  split(0, order_.size());
}

int NearestPoint::widest_axis(std::size_t begin, std::size_t end) const {
  Vec3d low = points_[order_[begin]], high = low;
  for (std::size_t i = begin; i < end; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], points_[order_[i]][axis]);
      high[axis] = std::max(high[axis], points_[order_[i]][axis]);
    }
  }
  const Vec3d size = high - low;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

void NearestPoint::split(std::size_t begin, std::size_t end) {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const int axis = widest_axis(begin, end);
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
    return std::make_pair(points_[a][axis], a) < std::make_pair(points_[b][axis], b);
  });
  axis_[middle] = axis;
  split(begin, middle);
  split(middle + 1, end);
}

void NearestPoint::look(std::size_t begin, std::size_t end, const Vec3d& p, Best& best) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2, point = order_[middle];
  const Vec3d d = points_[point] - p;
  best = std::min(best, Best{dot(d, d), point}, [](const Best& a, const Best& b) {
    return std::make_pair(a.square, a.point) < std::make_pair(b.square, b.point);
  });
  const double beyond = p[axis_[middle]] - points_[point][axis_[middle]];
  const bool is_low = beyond < 0;
  look(is_low ? begin : middle + 1, is_low ? middle : end, p, best);
  // A point just as near in the other half may come first.
  if (beyond * beyond <= best.square) look(is_low ? middle + 1 : begin, is_low ? end : middle, p, best);
}

std::size_t NearestPoint::operator()(const Vec3d& p) const {
  Best best{std::numeric_limits<double>::infinity(), points_.size()};
  look(0, order_.size(), p, best);
  return best.point;
}

}  // namespace espdiff
