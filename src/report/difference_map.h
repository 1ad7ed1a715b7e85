// difference_map.h: a quantity of the surface's vertices on a lattice around it, for programs that colour by volumes.
#pragma once

#include <vector>

#include "base/types.h"
#include "certificate/result.h"

namespace espdiff {

/// Up to this distance from the nearest vertex with a value, the map holds the surface's values ...
inline constexpr double kMapBand_A = 4;
/// ... and from this one on it is zero; between them it falls smoothly.
inline constexpr double kMapReach_A = 5;
inline constexpr double kLeastMapSpacing_A = 0.1, kMostMapSpacing_A = 4;

/// Carries a per-vertex quantity into space, so that other representations of the molecule near the surface can be
/// coloured by it (VMD's `Color Volume` on QuickSurf or Isosurface).
///
/// Method: at lattice point x the mean of the values v_i of the vertices within kMapReach_A, with weights
/// a_i exp(-|x - p_i|^2 / (2 s^2)); a_i is a third of the area of the triangles around vertex i, s = 1 A. This is
/// Shepard's interpolation with a Gaussian (D. Shepard, Proc. 23rd ACM Nat. Conf. 1968, 517), which does not overshoot:
/// the map stays between the least and the largest value, and zero. It smooths over about s: a steep change along the
/// surface becomes as wide as that. Vertices whose value is NaN, or that have no area, are left out.
///
/// The lattice lies along the coordinate axes of `positions`, its points at multiples of the spacing, and ends where
/// the map is zero. Runs on one thread, hence the same bits always; time grows with vertices / spacing^3.
///
/// @param positions [vertex] A  @param values [vertex], NaN for none  @param spacing_A 0.1 to 4
/// @returns the map, its unit unknown
/// @throws InputError (spacing, numbers that do not agree, no vertex with a value), MemoryError
Grid surface_quantity_map(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<float>& values, double spacing_A);

/// The same around a mapped surface, in the target's own frame.
inline Grid surface_quantity_map(const MappedSurface& surface, const std::vector<float>& values, double spacing_A) {
  return surface_quantity_map(surface.positions, surface.triangles, values, spacing_A);
}

}  // namespace espdiff
