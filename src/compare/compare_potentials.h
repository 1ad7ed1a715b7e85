// compare_potentials.h: the metrics of a step: both potentials at corresponding vertices.
#pragma once

#include <vector>

#include "base/handles.h"
#include "compare/measured_parts.h"

namespace espdiff {

struct CompareOptions;

/// One side's potential and the atoms of its surface.
struct PotentialSide {
  const CompareInput& input;
  GridPtr map;
  AtomsPtr atoms;
};

/// Samples both potentials and computes the metrics of their difference, at each distance outside the surfaces: over
/// the valid area, all area, the area without slip, and each part. Vertices have the first distance's potentials.
/// @param unit of both maps
/// @throws as sample_outside(), count_outside()
void compare_potentials(Engine& engine, const PotentialSide& source, const PotentialSide& target,
                        const CompareOptions& options, PotentialUnit unit, const std::vector<MeasuredPart>& parts,
                        MappedStep& step);

}  // namespace espdiff
