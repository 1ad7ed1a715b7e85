// write_grid.h: potential maps as OpenDX text files, as APBS and VMD read them.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

/// Writes `grid` as OpenDX text, z fastest, values with 9 significant digits (a float is read back bit by bit), the
/// unit in a comment: "# POTENTIAL (kT/e)". The file appears under its name when it is complete.
/// @throws InputError (number of values and lattice differ, values not finite), IoError
void write_dx(const std::string& path, const Grid& grid);

}  // namespace espdiff
