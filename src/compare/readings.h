// readings.h: readings of the potentials on a mapped surface, and their causes.
#pragma once

#include <vector>

#include "compare/compare_potentials.h"
#include "mapping/input.h"

namespace espdiff {

struct CompareOptions;

/// Before any work. @throws InputError (a potential that is not computed, a residue that the source lacks)
void check_causes(const CompareOptions& options, const CompareInput& source, const CompareInput& target);

/// As soon as the first potential is known. @throws InputError for causes of the nonlinear equation
void refuse_nonlinear(const CompareOptions& options, const MapRecipe& recipe);

/// One side's charges, in the order of its map.
struct SideCharges {
  const PotentialSide& side;
  const Molecule& charges;
};

/// The causes of the readings that the options ask for, into the step's result, whose residues and parts are complete.
/// @throws InputError (a reading without surface; the nonlinear equation), and as Engine::contributions()
void find_causes(Engine& engine, const SideCharges& source, const SideCharges& target, const CompareOptions& options,
                 const std::vector<MeasuredPart>& parts, const std::vector<std::int32_t>& target_of, MappedStep& step,
                 const Progress& progress);

}  // namespace espdiff
