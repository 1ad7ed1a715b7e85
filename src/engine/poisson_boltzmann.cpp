// poisson_boltzmann.cpp: chooses the grid of a Poisson-Boltzmann potential.
#include "engine/poisson_boltzmann.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

struct Box {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

Box box_around(const std::vector<Vec3d>& positions, const std::vector<float>& radii) {
  Box box;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double r = i < radii.size() ? static_cast<double>(radii[i]) : 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double c = positions[i][axis];
      if (!std::isfinite(c)) throw InputError("atom " + std::to_string(i + 1) + " has a coordinate that is not finite");
      box.low[axis] = std::min(box.low[axis], c - r);
      box.high[axis] = std::max(box.high[axis], c + r);
    }
  }
  return box;
}

}  // namespace

Lattice poisson_boltzmann_lattice(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                  double spacing_A, double padding_A) {
  if (!(spacing_A > 0) || !std::isfinite(spacing_A))
    throw InputError("grid spacing " + formatted(spacing_A) + " A is not a positive number; 0.5 is usual");
  if (!(padding_A >= 0) || !std::isfinite(padding_A))
    throw InputError("padding " + formatted(padding_A) + " A is not a number from 0 on; 6 is usual");
  if (positions.empty()) throw InputError("no atoms to lay a grid around");
  const Box box = box_around(positions, radii);
  Lattice lattice;
  double n_points = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const double extent = box.high[a] - box.low[a] + 2 * padding_A;
    // Halved three times without a remainder; what is added is padding.
    constexpr double kMultiple = 8;
    const double n_steps = std::max(1.0, std::ceil(extent / spacing_A / kMultiple)) * kMultiple;
    n_points *= n_steps + 1;
    if (n_points > 2.0e9)
      throw MemoryError("a grid of spacing " + formatted(spacing_A) +
                        " A around these atoms has more than 2e9 points; "
                        "use a larger spacing");
    lattice.size[axis] = static_cast<int>(n_steps) + 1;
    lattice.origin[a] = 0.5 * (box.low[a] + box.high[a]) - 0.5 * n_steps * spacing_A;
    lattice.step[axis][a] = spacing_A;
  }
  return lattice;
}

}  // namespace espdiff
