// orientation.cpp: principal axes of a surface's vertices.
#include "scene/orientation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace espdiff {
namespace {

Vec3d to_vec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Directs an axis, whose sign is arbitrary, toward the file's z, y or x: the first that is not nearly perpendicular.
Vec3d toward_file_axis(Vec3d axis) {
  for (int i = 2; i >= 0; --i) {
    if (std::abs(axis[i]) > 0.1) return axis[i] < 0 ? -1.0 * axis : axis;
  }
  return axis;
}

/// Columns by ascending extent.
Eigen::Matrix3d principal_axes(const std::vector<Vec3d>& positions) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Vec3d& p : positions) mean += Eigen::Vector3d(p.x, p.y, p.z);
  mean /= static_cast<double>(positions.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3d& p : positions) {
    const Eigen::Vector3d offset = Eigen::Vector3d(p.x, p.y, p.z) - mean;
    covariance += offset * offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
}

/// Half the extent along a direction, and its middle.
struct Extent {
  double half = 0, middle = 0;
};

Extent extent_along(const std::vector<Vec3d>& positions, Vec3d direction) {
  double low = dot(positions.front(), direction), high = low;
  for (const Vec3d& p : positions) {
    low = std::min(low, dot(p, direction));
    high = std::max(high, dot(p, direction));
  }
  return {(high - low) / 2, (high + low) / 2};
}

/// Whether the side away from the viewer has the larger mean |value|.
bool back_is_more_coloured(const std::vector<Vec3d>& positions, const std::vector<float>& values,
                           const Orientation& view) {
  double sum[2] = {0, 0};
  double n[2] = {0, 0};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int side = dot(positions[i] - view.centre, view.toward_viewer) < 0 ? 1 : 0;
    sum[side] += std::isfinite(values[i]) ? std::abs(values[i]) : 0;
    n[side] += 1;
  }
  return sum[1] / std::max(n[1], 1.0) > sum[0] / std::max(n[0], 1.0);
}

}  // namespace

Orientation choose_orientation(const std::vector<Vec3d>& positions, const std::vector<float>& values, bool upright,
                               int n_views) {
  const Eigen::Matrix3d axes = principal_axes(positions);
  Orientation view;
  view.up = toward_file_axis(to_vec3(axes.col(upright ? 2 : 1)));
  view.right = to_vec3(axes.col(upright ? 1 : 2));
  view.toward_viewer = cross(view.right, view.up);

  const Extent across = extent_along(positions, view.right);
  const Extent along = extent_along(positions, view.up);
  const Extent deep = extent_along(positions, view.toward_viewer);
  view.centre = across.middle * view.right + along.middle * view.up + deep.middle * view.toward_viewer;
  view.half_height_A = along.half;
  view.half_width_A = across.half;
  for (const Vec3d& p : positions) {
    const Vec3d offset = p - view.centre;
    view.radius_A = std::max(view.radius_A, norm(offset));
    // Turned views show all sides of the molecule, so they need the largest width.
    if (n_views > 2) {
      view.half_width_A =
          std::max(view.half_width_A, std::hypot(dot(offset, view.right), dot(offset, view.toward_viewer)));
    }
  }
  if (back_is_more_coloured(positions, values, view)) {
    view.right = -1.0 * view.right;
    view.toward_viewer = -1.0 * view.toward_viewer;
  }
  return view;
}

}  // namespace espdiff
