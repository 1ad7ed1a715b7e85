// separate_atoms.h: coordinates that no program can add hydrogens to.
#pragma once

namespace espdiff {

struct Molecule;

/// Refuses a molecule of whose atoms a tenth or more, and at least ten, lie within 0.5 A of another: one in nm, or one
/// with a chain on top of itself. PDB2PQR would try to move them apart, for minutes to an hour.
/// @throws InputError  names the first two
void require_separate_atoms(const Molecule& molecule);

}  // namespace espdiff
