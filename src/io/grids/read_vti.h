// read_vti.h: grids from VTK XML image data.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "io/grids/read_grid.h"
#include "io/vtk/vtk_xml.h"

namespace espdiff {

/// The data set of VTI files, for VtkXmlFile.
constexpr const char* kImageData = "ImageData";

/// Reads one point array of a VTI file: ascii, inline base64 or appended (raw, base64), compressed by zlib or not, any
/// number type and byte order, one piece or several that cover the whole extent. The direction matrix turns the axes;
/// the extent need not start at 0. Lengths are taken as Angstrom. The unit is that of the field array "unit", which
/// espdiff writes, otherwise unknown. WholeExtent, Origin and Spacing must be there: a default would be a guess.
/// @throws FormatError (damaged or truncated, sizes that do not agree, values that are not finite),
///         InputError (no such array, several to choose from, vectors, a compressor other than zlib), MemoryError
Grid read_vti(const VtkXmlFile& file, const GridOptions& options);

/// Names of the point arrays of a VTI file that have one number a point, in file order: those that read_vti() can take.
/// Values are not looked at; damaged ones are found by read_vti().
/// @throws FormatError (damaged)
std::vector<std::string> list_vti_scalars(const VtkXmlFile& file);

}  // namespace espdiff
