// surface_summary.h: counts and areas of one molecule's surface.
#pragma once

#include <cstddef>

namespace espdiff {

/// A molecule's surface in numbers.
struct SurfaceSummary {
  std::size_t n_vertices = 0;
  std::size_t n_triangles = 0;
  std::size_t n_components = 0;  ///< after removing cavities
  std::size_t n_cavities_left_out = 0;
  double area_A2 = 0;
  double cavity_area_A2 = 0;  ///< of the cavities removed
};

}  // namespace espdiff
