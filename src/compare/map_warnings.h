// map_warnings.h: what is wrong with the potentials of two states, given or computed, before they are compared.
#pragma once

#include <optional>
#include <vector>

#include "compare/result.h"

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
                   const MapReferences* of_target, const CompareResult& result, std::vector<Warning>& warnings);

/// What the two potentials of a result do not have in common, and single frames with explicit water. Vacuum against
/// solvent refuses.
std::vector<Warning> kind_warnings(const CompareResult& result);

}  // namespace espdiff
