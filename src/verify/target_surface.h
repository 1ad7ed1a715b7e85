// target_surface.h: a molecule's surface made by VTK, and distances to surfaces by VTK.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Atoms as Gaussians, in double precision.
class GaussianAtoms {
 public:
  /// @param widths [atom] standard deviations, Angstrom; 0 adds nothing
  /// @throws InputError (no atom has a width)
  GaussianAtoms(const std::vector<Vec3d>& positions, const std::vector<double>& widths);

  /// The density and its gradient at a point.
  double at(const Vec3d& p, Vec3d& gradient) const;
  /// The label whose atoms have the largest density at a point; -1 where no atom reaches.
  /// @param labels [atom] as given to the constructor
  std::int32_t strongest(const Vec3d& p, const std::vector<std::int32_t>& labels) const;
  /// The isosurface without closed cavities.
  vtkSmartPointer<vtkPolyData> surface(double isovalue, double spacing_A) const;

 private:
  std::size_t cell_of(const Vec3d& p, int axis) const;
  /// Calls visit(kept atom, vector from it, Gaussian) for each atom that reaches p.
  template <typename Visit>
  void visit(const Vec3d& p, Visit visit) const;

  std::vector<Vec3d> positions_;
  std::vector<double> widths_;
  std::vector<std::size_t> kept_;  ///< [atom with a width] its index as given
  Vec3d lower_{}, upper_{};
  double reach_ = 0;
  std::size_t size_[3] = {1, 1, 1};
  std::vector<std::vector<std::size_t>> cells_;
};

vtkSmartPointer<vtkPolyData> polydata(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

/// Distances of a surface to another one.
struct SurfaceDistances {
  double mean = 0, p95 = 0, max = 0, beyond = 0, mean_within = 0;
};
/// At the corners (a twelfth of each triangle's area each) and centroids (three quarters), which integrates quadratic
/// functions exactly.
SurfaceDistances distances(vtkPolyData* from, vtkPolyData* to, double limit_A);

double area_of(vtkPolyData* surface);

}  // namespace espdiff
