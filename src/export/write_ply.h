// write_ply.h: a comparison's surface as a PLY file.
#pragma once

#include <ostream>

#include "export/exported_result.h"

namespace espdiff {

/// Binary, little-endian. Vertices: x, y, z, nx, ny, nz (where the result has normals), source_x, source_y, source_z
/// (float, Angstrom), red, green, blue (uchar), then every quantity of surface_quantities() under its name (float, NaN
/// where it has no value). Faces: vertex_indices, the counted ones first; the comment `counted_faces N` says how
/// many there are. The others are corrupt or unmatched; vertices of these alone are grey. Notes are comments.
void write_ply(std::ostream& out, const ExportedResult& result);

}  // namespace espdiff
