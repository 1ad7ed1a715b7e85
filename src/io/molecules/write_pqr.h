// write_pqr.h: a molecule with charges and radii as a PQR file.
#pragma once

#include <ostream>

#include "base/types.h"

namespace espdiff {

/// Whether names, chains and residue numbers fit the columns of a PDB file, so that VMD reads what write_pqr writes.
bool fits_pdb_columns(const Molecule& molecule);

/// Writes ATOM and HETATM records. Where they fit, names and numbers stand in PDB's columns, as VMD needs them, and
/// coordinates of three decimals do so too; others take as many digits as they need, behind a blank. Otherwise fields
/// are separated by single blanks. A single-precision number is read back bit by bit. Charges of a molecule without
/// charges are 0. Blanks in names become underscores, and a name that is empty becomes X; an empty chain is left out.
/// @throws InputError when charges or radii are not one an atom
void write_pqr(std::ostream& out, const Molecule& molecule);

}  // namespace espdiff
