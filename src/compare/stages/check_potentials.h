// check_potentials.h: a step's two potentials before they are compared: against their molecules, and each other.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "certificate/result.h"
#include "compare/stages/mapped_step.h"
#include "input_checks/map_check.h"
#include "mapping/input.h"

namespace espdiff {

/// What the checks of potentials found.
struct PotentialFindings {
  std::vector<Warning> warnings;
  std::vector<std::string> not_checked;  ///< names of the checks that were not made
};

/// Given maps against the molecules, and the two potentials against each other.
/// @param references of the source's given map, for all steps: made when the first one asks for it
/// @param maps       with the recipes of computed ones; receives the checks of given ones
/// @throws InputError (a potential in vacuum against one in solvent, unless the options trust maps)
PotentialFindings check_potentials(const StatesToMap& states, const CommonFrame& frame, const CompareInput& source,
                                   const CompareInput& target, std::shared_ptr<const MapReferences>& references,
                                   ComparedMaps& maps, const Progress& progress);

}  // namespace espdiff
