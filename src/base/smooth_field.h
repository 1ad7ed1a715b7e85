// smooth_field.h: means over neighbouring vertices of a mesh, for lines and shades in pictures.
#pragma once

#include <vector>

#include "base/types.h"

namespace espdiff {

/// Replaces each value, `rounds` times, by the mean of itself and its one-ring's mean. For drawing only: no number of a
/// result comes from here. Vertices that are NaN stay NaN, and count for no neighbour.
/// @param triangles [triangle] of a closed surface; at a border, border edges count half
/// @param values [vertex]
std::vector<float> smoothed_over_neighbours(const std::vector<Triangle>& triangles, std::vector<float> values,
                                            int rounds);

/// The uncertainty that shades a drawn surface: smoothed, so that the shaded parts have smooth borders.
/// @param uncertainty [vertex] Angstrom
std::vector<float> drawn_uncertainty(const std::vector<Triangle>& triangles, std::vector<float> uncertainty);

}  // namespace espdiff
