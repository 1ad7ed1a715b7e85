// superpose.cpp: Kabsch's rotation by singular value decomposition, and algebra of rigid transforms.
#include "align/geometry/superpose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace espdiff {
namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Points are collinear if the ratio of the second to the first singular value of the covariance is below this: a width
/// of about 1e-5 of the length, far below any molecule's and far above rounding.
constexpr double kCollinear = 1e-10;
/// A third moment below this fraction of the spread does not determine the direction of an axis.
constexpr double kSymmetric = 1e-9;

/// Radians: a smaller rotation moves no atom noticeably, and its axis is noise.
constexpr double kNoRotation = 1e-6;

Eigen::Vector3d to_eigen(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

RigidTransform make_transform(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  RigidTransform transform;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) transform.rotation[3 * row + column] = rotation(row, column);
  }
  transform.translation = from_eigen(translation);
  return transform;
}

Eigen::Matrix3d rotation_of(const RigidTransform& transform) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(transform.rotation);
}

/// The rotation R that minimizes the sum of |fixed - R moving|^2, from the covariance, the sum of moving * fixed^T.
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) throw GeometryError("the position of a paired atom is not finite");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (!(singular(1) > kCollinear * singular(0))) {
    throw GeometryError(Message("the paired atoms lie on a line or in a point, so that no rotation superposes them "
                                "best; pair more atoms (") +
                        option("align", "all") + ") or use " + option("align", "none"));
  }
  const double sign = svd.matrixV().determinant() * svd.matrixU().determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixV() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixU().transpose();
}

/// Directs an axis so that the third moment of the points along it is positive; if that vanishes by symmetry, so that
/// its largest component is positive.
Eigen::Vector3d directed(const Eigen::Vector3d& axis, const std::vector<Eigen::Vector3d>& centred) {
  double third = 0, spread = 0;
  for (const Eigen::Vector3d& p : centred) {
    const double along = axis.dot(p);
    third += along * along * along;
    spread += std::fabs(along * along * along);
  }
  if (std::fabs(third) > kSymmetric * spread) return third > 0 ? axis : Eigen::Vector3d(-axis);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis(largest) > 0 ? axis : Eigen::Vector3d(-axis);
}

}  // namespace

Superposition superpose(const std::vector<Vec3d>& moving, const std::vector<Vec3d>& fixed, const IndexPairs& pairs) {
  if (pairs.size() < 3) {
    throw GeometryError("a superposition needs at least 3 pairs of atoms, " + std::to_string(pairs.size()) +
                        " were given; pair more atoms (" + option("align", "all") + ") or use " +
                        option("align", "none"));
  }
  Eigen::Vector3d moving_centre = Eigen::Vector3d::Zero(), fixed_centre = Eigen::Vector3d::Zero();
  for (const auto& [m, f] : pairs) {
    moving_centre += to_eigen(moving[m]);
    fixed_centre += to_eigen(fixed[f]);
  }
  moving_centre /= static_cast<double>(pairs.size());
  fixed_centre /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [m, f] : pairs) {
    covariance += (to_eigen(moving[m]) - moving_centre) * (to_eigen(fixed[f]) - fixed_centre).transpose();
  }
  const Eigen::Matrix3d rotation = best_rotation(covariance);
  Superposition result;
  result.transform = make_transform(rotation, fixed_centre - rotation * moving_centre);
  double sum = 0;
  for (const auto& [m, f] : pairs) {
    sum += (rotation * (to_eigen(moving[m]) - moving_centre) - (to_eigen(fixed[f]) - fixed_centre)).squaredNorm();
  }
  result.rmsd_A = std::sqrt(sum / static_cast<double>(pairs.size()));
  return result;
}

double rmsd(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, const IndexPairs& pairs) {
  if (pairs.empty()) throw GeometryError("the RMSD of no pairs of atoms is undefined");
  double sum = 0;
  for (const auto& [i, j] : pairs) {
    const Vec3d difference = a[i] - b[j];
    sum += dot(difference, difference);
  }
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

RigidTransform inverse(const RigidTransform& transform) {
  const Eigen::Matrix3d transposed = rotation_of(transform).transpose();
  return make_transform(transposed, -(transposed * to_eigen(transform.translation)));
}

RigidTransform compose(const RigidTransform& outer, const RigidTransform& inner) {
  return make_transform(rotation_of(outer) * rotation_of(inner), to_eigen(outer.apply(inner.translation)));
}

Screw screw_of(const RigidTransform& transform) {
  const Eigen::AngleAxisd turn(rotation_of(transform));
  Screw screw;
  screw.shift = transform.translation;
  if (turn.angle() < kNoRotation) return screw;
  const Eigen::Vector3d& axis = turn.axis();
  const Eigen::Vector3d translation = to_eigen(transform.translation);
  const Eigen::Vector3d along = axis.dot(translation) * axis, across = translation - along;
  screw.axis = from_eigen(axis);
  screw.angle = turn.angle();
  screw.shift = from_eigen(along);
  // (1 - R) through = across
  screw.through = from_eigen(0.5 * (across + axis.cross(across) / std::tan(turn.angle() / 2)));
  return screw;
}

RigidTransform principal_frame(const std::vector<Vec3d>& positions) {
  if (positions.empty()) throw GeometryError("a molecule without atoms has no principal axes");
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Vec3d& p : positions) centre += to_eigen(p);
  centre /= static_cast<double>(positions.size());
  std::vector<Eigen::Vector3d> centred;
  centred.reserve(positions.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vec3d& p : positions) {
    centred.push_back(to_eigen(p) - centre);
    scatter += centred.back() * centred.back().transpose();
  }
  // Eigenvalues are ascending, so the last axis comes first.
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  Eigen::Matrix3d rotation;
  rotation.row(0) = directed(axes.col(2), centred);
  rotation.row(1) = directed(axes.col(1), centred);
  rotation.row(2) = rotation.row(0).cross(rotation.row(1));
  return make_transform(rotation, -(rotation * centre));
}

}  // namespace espdiff
