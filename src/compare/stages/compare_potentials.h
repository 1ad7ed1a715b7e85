// compare_potentials.h: the metrics of a step: both potentials at corresponding vertices.
#pragma once

#include <vector>

#include "base/handles.h"
#include "certificate/result.h"
#include "compare/stages/measured_parts.h"
#include "mapping/build_surface.h"

namespace espdiff {

struct CompareOptions;

/// One side's potential, and the surface that it is read on.
struct PotentialSide {
  const CompareInput& input;
  GridPtr map;
  const Surface& surface;
};

/// Both potentials at one distance outside the surfaces.
struct PotentialSamples {
  std::vector<float> source, target;  ///< [vertex] NaN outside a map and inside a surface
  OffsetMetrics counted;              ///< without the metrics
};

/// Samples both potentials at each distance outside the surfaces.
/// @throws as sample_outside(), count_outside()
std::vector<PotentialSamples> sample_potentials(Engine& engine, const PotentialSide& source,
                                                const PotentialSide& target, const CompareOptions& options,
                                                const MappedStep& step);

/// The metrics of the difference at each distance: over the trusted area, over all area, and over the trusted area of
/// each part.
/// @param surface says where the area is trusted
/// @param parts receive their comparison
PotentialComparison compare_potentials(Engine& engine, const std::vector<PotentialSamples>& samples, PotentialUnit unit,
                                       const MappedStep& step, const MappedSurface& surface,
                                       std::vector<MeasuredPart>& parts);

}  // namespace espdiff
