// write_glb.h: a comparison's surface as a binary glTF 2.0 file.
#pragma once

#include <ostream>

#include "export/exported_result.h"

namespace espdiff {

/// One mesh, one unit an Angstrom, in the target's frame: POSITION, NORMAL, COLOR_0 (linear, as glTF asks), and every
/// quantity of surface_quantities() as `_NAME` (float; 0 where it has no value, since glTF forbids NaN; `_HAS_VALUE` is
/// then 0 where the coloured quantity has none). A morph target, `source`, moves the surface to the source's. A second
/// primitive, grey and half transparent, has the triangles that are corrupt or unmatched. Notes are the
/// asset's extras.
void write_glb(std::ostream& out, const ExportedResult& result);

}  // namespace espdiff
