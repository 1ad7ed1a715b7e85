// read_grid.h: scalar grids from OpenDX, VTI and Gaussian cube files, told apart by content.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

struct GridOptions {
  std::string array;  ///< VTI point array to take; empty takes the active scalars, or the only array
};

/// Reads a grid. DX as APBS and PMEPot write it (any axes; gzip too), VTI by VTK (ascii, binary, appended; any number
/// type), Gaussian cube (Bohr or, with negative counts, Angstrom; converted to Angstrom; first volume of several).
/// Files are re-ordered to x fastest. The unit is taken from the file where it says one (APBS: "kT/e" in a comment),
/// else unknown.
/// @throws IoError, FormatError (with line: fewer or more values than promised, NaN or infinite values, zero or
/// negative
///         counts, degenerate axes), InputError (unknown format, array missing, VTI in a build without VTK, with
///         remedy)
Grid read_grid(const std::string& path, const GridOptions& options = {});

}  // namespace espdiff
