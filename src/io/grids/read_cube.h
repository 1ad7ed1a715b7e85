// read_cube.h: grids from Gaussian cube files.
#pragma once

#include <string>
#include <string_view>

#include "base/types.h"

namespace espdiff {

/// Reads the first volume of a cube file, z fastest in the file. Positive counts mean that lengths are in Bohr,
/// negative ones that they are in Angstrom. A negative atom count, or a fifth number beside the origin, tells of
/// several volumes, whose values alternate point by point. Cube files do not tell the values' unit.
/// @throws FormatError (with line: counts, axes, fewer or more values than promised, values that are not finite)
Grid read_cube(const std::string& path, std::string_view text);

}  // namespace espdiff
