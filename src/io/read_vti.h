// read_vti.h: grids from VTK XML image data.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "io/read_grid.h"

namespace espdiff {

/// Reads one point array of a VTI file (ascii, binary, appended; compressed or not; any number type) with VTK. The
/// direction matrix turns the axes; the extent need not start at 0. Lengths are taken as Angstrom; the unit is unknown.
/// VTK's own error output is kept off the terminal and becomes part of the exception.
/// @throws FormatError (damaged or truncated, sizes that do not agree, values that are not finite),
///         InputError (no such array, several to choose from, vectors), MemoryError
Grid read_vti(const std::string& path, const GridOptions& options);

/// Names of the point arrays of a VTI file that have one number a point, in file order: those that read_vti() can take.
/// Reads the header only; damaged values are found by read_vti().
/// @throws FormatError (damaged or cut short), IoError
std::vector<std::string> list_vti_scalars(const std::string& path);

}  // namespace espdiff
