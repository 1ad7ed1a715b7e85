// read_grid.h: scalar grids from OpenDX, VTI and Gaussian cube files, distinguished by content.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

struct GridOptions {
  std::string array{};  ///< VTI point array to take; empty takes the active scalars, or the only array
  std::string unit{};   ///< of the potential, by take_unit(); empty takes the file's
};

/// Reads a grid: OpenDX as APBS, PMEPot and VMD write it (any axes; gzip too), VTI (ascii, binary, appended; any
/// number type; gzip too), Gaussian cube (Bohr or, with negative counts, Angstrom; converted to Angstrom; first volume
/// of several). The format is found from the content. Values are re-ordered to x fastest. The unit is taken from the
/// file where it says one ("POTENTIAL (kT/e)"), otherwise unknown. A header that promises more than the file can hold
/// is refused before anything is allocated.
/// @throws IoError (missing, directory, unreadable)
/// @throws FormatError (with line: fewer or more values than promised, not finite, counts below 2, degenerate axes)
/// @throws InputError (format not read, array missing, VTI in a build without VTK, with remedy), MemoryError
Grid read_grid(const std::string& path, const GridOptions& options = {});

/// A grid and the file that it came from, read once.
struct GridFile {
  Grid grid;
  std::string sha256;  ///< of the file
};
/// @throws as read_grid()
GridFile read_grid_file(const std::string& path, const GridOptions& options = {});

/// Gives the map this unit; one that the file stated, and that differs, becomes its contradicting title.
/// @throws InputError as parse_potential_unit()
void take_unit(const std::string& text, Grid& map);

}  // namespace espdiff
