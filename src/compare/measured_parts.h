// measured_parts.h: the region and the patches of a step, from their place on the mapping to their verdict.
#pragma once

#include <memory>
#include <vector>

#include "certificate/region_result.h"
#include "compare/mapped_step.h"
#include "mapping/input.h"

namespace espdiff {

/// A region or patch: where it is, and its numbers.
struct MeasuredPart {
  SurfacePart place;
  std::shared_ptr<CompareResult> result;
  std::shared_ptr<const PatchPlacement> placement;  ///< of an earlier patch; null for others
};

/// The source's region and patches, which become part of the step's result; without potentials, and not judged.
/// @param target_of [source residue] from paired_residues()
std::vector<MeasuredPart> measure_parts(Engine& engine, const CompareInput& source, const CompareInput& target,
                                        const Surface& target_surface, float isovalue,
                                        const std::vector<std::int32_t>& target_of, MappedStep& step);

/// A part's residues, vertices outside a map, and verdict, from the finished rows and warnings of the whole.
/// @param areas of the whole surface  @param required_share as in judge()
void finish_part(const MeasuredPart& part, const CompareResult& whole, const SurfaceAreas& areas,
                 const Molecule& source, double required_share);

}  // namespace espdiff
