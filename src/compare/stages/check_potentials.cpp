// check_potentials.cpp: the warnings of two potentials, in the order in which they are given.
#include "compare/stages/check_potentials.h"

#include <utility>

#include "input_checks/map_warnings.h"
#include "options/options.h"

namespace espdiff {

PotentialFindings check_potentials(const StatesToMap& states, const CommonFrame& frame, const CompareInput& source,
                                   const CompareInput& target, std::shared_ptr<const MapReferences>& references,
                                   ComparedMaps& maps, const Progress& progress) {
  const CompareOptions& options = states.options;
  const auto references_of = [&](const CompareInput& side, const Surface& surface, const RigidTransform& to_common) {
    return std::make_shared<const MapReferences>(states.engine, *side.molecule, to_common, surface, states.isovalue(),
                                                 options.temperature_K, progress);
  };
  PotentialFindings found;
  std::vector<Warning> refusing;  // unless the options trust maps
  const auto check = [&](const char* role, const CompareInput& side, const MapReferences& of_side,
                         std::shared_ptr<const MapCheck>& outcome) {
    for (Warning& warning : map_warnings(role, *side.map, of_side, options.temperature_K, outcome))
      refusing.push_back(std::move(warning));
    if (!outcome) found.not_checked.emplace_back(std::string("map_of_") + role);
  };
  std::shared_ptr<const MapReferences> of_target;
  if (source.map != nullptr) {
    if (!references) references = references_of(source, states.source_surface, frame.from_source);
    check("source", source, *references, maps.source_check);
  }
  if (target.map != nullptr) {
    of_target = references_of(target, states.target_surface, frame.from_target);
    check("target", target, *of_target, maps.target_check);
  }
  pair_warnings(source, target, references.get(), of_target.get(), maps, refusing);
  if (!options.trust_maps) refuse_vacuum_against_solvent(maps);
  for (Warning& warning : kind_warnings(maps)) refusing.push_back(std::move(warning));
  for (Warning& warning : refusing) {
    warning.refuses = warning.refuses && !options.trust_maps;
    found.warnings.push_back(std::move(warning));
  }
  for (Warning& warning : water_warnings(maps)) found.warnings.push_back(std::move(warning));
  return found;
}

}  // namespace espdiff
