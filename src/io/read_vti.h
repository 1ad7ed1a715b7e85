// read_vti.h: grids from VTK XML image data.
#pragma once

#include <string>

#include "base/types.h"
#include "io/read_grid.h"

namespace espdiff {

/// Reads one point array of a VTI file (ascii, binary, appended; compressed or not; any number type) with VTK. The
/// direction matrix turns the axes; the extent need not start at 0. Lengths are taken as Angstrom; the unit is unknown.
/// VTK's own error output is kept off the terminal and becomes part of the exception.
/// @throws FormatError (damaged or truncated, sizes that do not agree, values that are not finite),
///         InputError (no such array, several to choose from, vectors), MemoryError
Grid read_vti(const std::string& path, const GridOptions& options);

}  // namespace espdiff
