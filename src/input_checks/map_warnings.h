// map_warnings.h: what is wrong with the potentials of two states, given or computed, before they are compared.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct CompareInput;
class MapReferences;

/// Checks a given map against the potentials of its molecule's charges: its correlation with the best of them, and the
/// slope, which tells the unit. A map of another molecule or place, of another unit, turned in sign, or of another
/// quantity refuses; one whose title says otherwise, one without a unit, or as large as another unit's, is a warning.
/// @param role  "source" or "target"
/// @param check receives the regression; null where the map cannot be checked, such as without charges
std::vector<Warning> map_warnings(const char* role, const Grid& map, const MapReferences& references,
                                  double temperature_K, std::shared_ptr<const MapCheck>& check);

/// The pair's maps: one map given for two different states refuses; exchanged ones replace what was said of each.
/// @param warnings of map_warnings(), receives more
/// @param of_source, of_target null where the side's map was computed
void pair_warnings(const CompareInput& source, const CompareInput& target, const MapReferences* of_source,
                   const MapReferences* of_target, const ComparedMaps& maps, std::vector<Warning>& warnings);

/// A potential in vacuum against one in solvent: their difference is the solvent's, whatever the states.
/// @throws InputError  where both kinds are known
void refuse_vacuum_against_solvent(const ComparedMaps& maps);

/// The same of the given maps of an ensemble.
/// @param first, other may be null: not checked
/// @throws InputError  names the first; the caller names the other
void refuse_other_kind(const std::string& name_of_first, const std::shared_ptr<const MapCheck>& first,
                       const std::shared_ptr<const MapCheck>& other);

/// Single frames with explicit water, by PME: refuses, and no option takes it as it is.
std::vector<Warning> water_warnings(const ComparedMaps& maps);

/// What else the two potentials do not have in common. None of it refuses.
std::vector<Warning> kind_warnings(const ComparedMaps& maps);

}  // namespace espdiff
