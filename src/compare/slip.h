// slip.h: the slip of a mapping over its area.
#pragma once

#include <cstddef>
#include <vector>

#include "compare/result.h"

namespace espdiff {

/// [vertex] a third of the area of each matched triangle at the vertex.
std::vector<double> matched_areas(const MappedSurface& surface);

/// @param areas from matched_areas()
SlipSummary summarize_slip(const MappedSurface& surface, const std::vector<double>& areas);

/// [triangle] nonzero where the mean slip of the corners exceeds kMediumSlip_A or is not known.
std::vector<float> slipped_triangles(const MappedSurface& surface);

}  // namespace espdiff
