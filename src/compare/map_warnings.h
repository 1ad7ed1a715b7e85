// map_warnings.h: whether the given maps belong to their molecules.
#pragma once

#include <vector>

#include "compare/result.h"

namespace espdiff {

struct CompareInput;

/// Correlation of a map's values at the atoms with the atoms' charges. A potential peaks at its own charges: 0.9 and
/// more for the molecule that it was computed for, near 0 for a map shifted by 3 A. NaN without charges, or where fewer
/// than 20 atoms lie in the map.
/// @param map in the coordinates of the molecule
double map_correlation(const Grid& map, const Molecule& molecule);

/// Compares each given map with its molecule, and with the other molecule: exchanged maps fit the other one better. In
/// time linear in the number of atoms. Computed maps belong to their molecules.
/// @param checked receives whether a map could be checked
std::vector<Warning> map_warnings(const CompareInput& source, const CompareInput& target, bool& checked);

}  // namespace espdiff
