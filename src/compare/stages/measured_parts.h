// measured_parts.h: the region and the patches of a step, from their place on the mapping to their verdict.
#pragma once

#include <cstdint>
#include <vector>

#include "certificate/region_result.h"
#include "compare/stages/mapped_step.h"
#include "mapping/input.h"

namespace espdiff {

/// A region or patch: where it is, and its numbers.
struct MeasuredPart {
  SurfacePart place;
  PartResult result;
};

/// The source's region and patches, as its input names them; without potentials, and not judged.
/// @param target_of [source residue] from paired_residues()
std::vector<MeasuredPart> measure_parts(const StatesToMap& states, const MappedStep& step, const SurfaceParts& asked,
                                        const std::vector<std::int32_t>& target_of);

/// A part's residues, vertices outside a map, and verdict, from the finished rows and warnings of the whole.
/// @param areas of the whole surface  @param required_share as in judge()
void finish_part(MeasuredPart& part, const CompareResult& whole, const SurfaceAreas& areas, const Molecule& source,
                 double required_share);

}  // namespace espdiff
