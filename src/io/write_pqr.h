// write_pqr.h: a molecule with charges and radii as a PQR file.
#pragma once

#include <ostream>

#include "base/types.h"

namespace espdiff {

/// Writes ATOM and HETATM records in the free format, parted by blanks, so that names of any length fit. Positions,
/// charges and radii have 9 significant digits: a single-precision number is read back bit by bit. Charges of a
/// molecule without charges are 0. Blanks in names become underscores, and a name that is empty becomes X; an empty
/// chain is left out.
/// @throws InputError when charges or radii are not one an atom
void write_pqr(std::ostream& out, const Molecule& molecule);

}  // namespace espdiff
