// map_deviation.cpp: linear interpolation in a VTK image.
#include "verify/map_deviation.h"

#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/grids/read_grid.h"

namespace espdiff {
namespace {

bool is_straight(const Grid& map) {
  const auto& step = map.lattice.step;
  return step[0].y == 0 && step[0].z == 0 && step[1].x == 0 && step[1].z == 0 && step[2].x == 0 && step[2].y == 0 &&
         step[0].x > 0 && step[1].y > 0 && step[2].z > 0;
}

double interpolated(vtkImageData* image, const int cell[3], const double within[3]) {
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = ((corner >> axis) & 1) != 0;
      at[axis] = std::min(cell[axis] + (upper ? 1 : 0), image->GetDimensions()[axis] - 1);
      weight *= upper ? within[axis] : 1 - within[axis];
    }
    sum += weight * image->GetScalarComponentAsDouble(at[0], at[1], at[2], 0);
  }
  return sum;
}

}  // namespace

std::string map_deviation(const VerifiedInput& input, const std::string& unit, const std::vector<Vec3d>& points,
                          const std::vector<double>& potentials, double& largest, double& scale) {
  if (read_input(input.path).sha256 != input.sha256)
    throw InputError(input.path + ": has changed since the comparison; compare again");
  const Grid map = read_grid(input.path);
  if (!is_straight(map)) return "the map's axes are not those of its coordinates";
  if (to_string(map.unit) != unit) return "the map has another unit, or does not say which";
  vtkNew<vtkImageData> image;
  image->SetDimensions(map.lattice.size.data());
  image->SetOrigin(map.lattice.origin.x, map.lattice.origin.y, map.lattice.origin.z);
  image->SetSpacing(map.lattice.step[0].x, map.lattice.step[1].y, map.lattice.step[2].z);
  vtkNew<vtkDoubleArray> values;
  for (const float value : map.values) values->InsertNextValue(static_cast<double>(value));
  image->GetPointData()->SetScalars(values);
  for (std::size_t v = 0; v < points.size(); ++v) {
    CancelRequest().check();
    if (!std::isfinite(potentials[v])) continue;
    int cell[3];
    double x[3] = {points[v].x, points[v].y, points[v].z}, within[3];
    if (image->ComputeStructuredCoordinates(x, cell, within) == 0) continue;
    largest = std::max(largest, std::fabs(interpolated(image, cell, within) - potentials[v]));
    scale = std::max(scale, std::fabs(potentials[v]));
  }
  return "";
}

}  // namespace espdiff
