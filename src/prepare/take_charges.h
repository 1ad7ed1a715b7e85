// take_charges.h: charges and radii of one state for another one of the same atoms.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

/// Gives a molecule without charges and radii of its own (PDB, mmCIF, GRO), such as a frame, those of another state
/// (PQR). Atoms pair by name and residue (pair_atoms()), every atom of both. A molecule that has them keeps them.
/// @param name of the frame, for messages
/// @throws InputError when atoms are left over on either side, with the first of them
void take_values(Molecule& frame, const Molecule& molecule, const std::string& name);

/// Whether take_values() can pair every atom of both.
bool has_same_atoms(const Molecule& frame, const Molecule& molecule);

}  // namespace espdiff
