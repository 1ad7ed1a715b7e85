// read_ccp4.h: grids from CCP4 and MRC files: electron densities, cryo-EM maps.
#pragma once

#include <string>
#include <string_view>

#include "base/types.h"

namespace espdiff {

/// Reads a CCP4 or MRC2014 file, little- or big-endian, of 8- or 16-bit integers or 32-bit floats: the points that the
/// file has, in any order of its axes, without symmetry. The place is that of the header's start or, where one is
/// given, MRC's origin. A file of a crystal's whole cell is periodic.
/// Cheng et al., MRC2014: Extensions to the MRC format header for electron cryo-microscopy and tomography, J. Struct.
/// Biol. 192, 146 (2015), for the header.
/// @throws FormatError (sizes, cell, axes, a kind of values that is not read, values that are missing or not finite),
///         MemoryError
Grid read_ccp4(const std::string& path, std::string_view bytes);

}  // namespace espdiff
