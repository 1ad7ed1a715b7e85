// compare_potentials.h: the metrics of a step: both potentials at corresponding vertices.
#pragma once

#include <vector>

#include "base/handles.h"
#include "certificate/result.h"
#include "compare/measured_parts.h"

namespace espdiff {

struct CompareOptions;

/// One side's potential and the atoms of its surface.
struct PotentialSide {
  const CompareInput& input;
  GridPtr map;
  AtomsPtr atoms;
};

/// Both potentials at one distance outside the surfaces.
struct PotentialSamples {
  std::vector<float> source, target;  ///< [vertex] NaN outside a map and inside a surface
  OffsetMetrics counted;              ///< without the metrics
};

/// Samples both potentials at each distance outside the surfaces. The result's vertices have those of the first.
/// @param unit of both maps
/// @throws as sample_outside(), count_outside()
std::vector<PotentialSamples> sample_potentials(Engine& engine, const PotentialSide& source,
                                                const PotentialSide& target, const CompareOptions& options,
                                                PotentialUnit unit, MappedStep& step);

/// The metrics of the difference at each distance: over the trusted area, over all area, and over the trusted area of
/// each part.
void compare_potentials(Engine& engine, const std::vector<PotentialSamples>& samples,
                        const std::vector<MeasuredPart>& parts, MappedStep& step);

}  // namespace espdiff
