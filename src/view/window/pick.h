// pick.h: the point of the surface under the mouse, and the values there.
#pragma once

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/comparison_files.h"
#include "view/surface/surface_geometry.h"

namespace espdiff {

/// A point of the surface and its mapped position.
struct PickedPoint {
  std::size_t triangle = 0;
  std::array<double, 3> weights{};  ///< of the triangle's corners
  float source = 0, target = 0;     ///< potentials; NaN: no value
  float displacement_A = 0;         ///< NaN: unknown
  float slip_A = 0;                 ///< NaN: unknown
  int residue = -1;                 ///< index into the source's residues; negative: none
  int residue_number = 0;
  bool is_untrusted = false, is_matched = true;
  int why = 0;             ///< code of the reason why it is not trusted
  bool from_maps = false;  ///< potentials looked up in the maps, not interpolated between vertices
};

class SurfacePicker {
 public:
  /// All are kept by reference.
  SurfacePicker(const ComparisonFiles& files, const StartSurface& start) : files_(files), start_(start) {}

  /// The first point where a line meets the surface as drawn at a stage of the morph. Unmatched parts are included on
  /// the source only. Building the search structure costs about 10 ms per stage.
  std::optional<PickedPoint> pick(Vec3d from, Vec3d to, double morph);

  /// Position of a picked point at a stage of the morph.
  Vec3d place(const PickedPoint& point, double morph) const;

 private:
  void prepare(double morph);
  PickedPoint describe(std::size_t triangle, std::array<double, 3> weights) const;
  Vec3d vertex(std::size_t i, double morph) const;

  const ComparisonFiles& files_;
  const StartSurface& start_;
  double prepared_ = -1;
  std::vector<std::size_t> triangles_;  ///< [cell of the search structure]
  vtkNew<vtkPolyData> shape_;
  vtkNew<vtkStaticCellLocator> locator_;
};

/// Description of a picked point, line by line.
std::vector<std::string> picked_in_words(const PickedPoint& point, const ComparisonFiles& files,
                                         const std::string& unit);

}  // namespace espdiff
