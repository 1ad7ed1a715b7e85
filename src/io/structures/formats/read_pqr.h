// read_pqr.h: molecules with charges and radii from PQR files.
#pragma once

#include <string>

#include "base/molecule/structure_options.h"
#include "base/types.h"
#include "io/structures/atom_records.h"

namespace espdiff {

/// Reads the atoms of one model. Fields are separated by blanks: record, serial, atom, residue, [chain,] number (with
/// an insertion code glued on, or a chain in front), x, y, z, charge, radius. Where fields run together (too few of
/// them, or a name of more than four characters) the line is read by PDB's columns instead (coordinates in 31 to 54),
/// charge and radius behind them by blanks or as widths 8 and 7. Units: Angstrom, elementary charges.
/// @throws FormatError (columns that cannot be distinguished, bad numbers, negative radius), InputError (no atoms left)
Molecule read_pqr(const std::string& path, const AtomModel& model, const StructureOptions& options);

}  // namespace espdiff
