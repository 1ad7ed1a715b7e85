// evaluate.h: a mapping's numbers: potentials, fields, residues, parts, and the verdict.
#pragma once

#include <optional>
#include <vector>

#include "base/progress.h"
#include "certificate/result.h"
#include "compare/stages/compare_fields.h"
#include "compare/stages/mapped_step.h"
#include "compare/stages/readings.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"

namespace espdiff {

/// One side of a step; all in the common frame.
struct ComparedSide {
  CompareInput input;
  StateFields fields{};  ///< one for each field that is compared
  MadeMap map{};         ///< without `map` where there is none
  Surface surface{};
};

/// Adds warnings behind those of earlier stages.
void append(std::vector<Warning>& all, std::vector<Warning> more);

/// The numbers of a mapping, stage by stage, and the verdicts on the whole and its parts.
/// @param fields besides the potential, as both sides have them  @param unit of both potentials
/// @param step   its surface and rows become the result's
/// @param result with what the stages before found; receives the rest, but for the causes
/// @returns the readings whose causes are asked for
std::optional<Readings> evaluate(const StatesToMap& states, const std::vector<Field>& fields,
                                 const ComparedSide& source, const ComparedSide& target, PotentialUnit unit,
                                 MappedStep& step, CompareResult& result, const Progress& progress, StageClock& clock);

}  // namespace espdiff
