// write_grid.h: potential maps as OpenDX text, as APBS and VMD read it, and as VTI.
#pragma once

#include <ostream>
#include <string>

#include "base/types.h"

namespace espdiff {

class AtomicFile;

/// Writes `grid` as OpenDX text, z fastest, values with 9 significant digits (a float is read back bit by bit), the
/// unit in a comment: "# POTENTIAL (kT/e)". The file appears under its name when it is complete.
/// @throws InputError (number of values and lattice differ, values not finite), IoError
void write_dx(const std::string& path, const Grid& grid);

/// The same without giving the file its name: the caller commits.
void write_dx(AtomicFile& file, const Grid& grid);

/// Writes `grid` as VTK XML image data: Float32 scalars "potential", appended as they lie in memory, the unit as the
/// field "unit". Axes that are skewed or turned are in the Direction matrix (VTK 9).
/// @throws as write_dx()
void write_vti(const std::string& path, const Grid& grid);

/// The content of such a file.
/// @throws InputError as write_dx(), naming the grid
void write_vti(std::ostream& out, const Grid& grid);

/// Writes the whole file's content in the format of its name's ending, .dx or .vti, without giving it its name: the
/// caller commits.
/// @throws as write_dx(); InputError for other endings
void write_map(AtomicFile& file, const Grid& grid);
/// @throws InputError unless the path ends in .dx or .vti
void check_map_ending(const std::string& path);

}  // namespace espdiff
