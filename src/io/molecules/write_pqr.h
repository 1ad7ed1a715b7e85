// write_pqr.h: a molecule with charges and radii as a PQR file.
#pragma once

#include <ostream>

#include "base/types.h"

namespace espdiff {

/// Writes ATOM and HETATM records. Where all atoms fit, in PDB's columns with blanks between the fields, as VMD and
/// APBS read them; otherwise in the free format, separated by single blanks. A single-precision number is read back bit
/// by bit. Charges of a molecule without charges are 0. Blanks in names become underscores, and a name that is empty
/// becomes X; an empty chain is left out.
/// @throws InputError when charges or radii are not one an atom
void write_pqr(std::ostream& out, const Molecule& molecule);

}  // namespace espdiff
