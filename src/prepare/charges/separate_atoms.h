// separate_atoms.h: what no program can add hydrogens to.
#pragma once

#include <string>

namespace espdiff {

struct Molecule;

/// Finds hydrogens on top of other atoms, ten or more, as programs leave them that place them roughly. Heavy atoms lie
/// apart. @returns what is wrong, for people: "26 atoms lie within 0.5 A of another (...)"; empty where nothing is
std::string misplaced_hydrogens(const Molecule& molecule);

/// Refuses a molecule of whose atoms a tenth or more, and at least ten, lie within 0.5 A of another: one in nm, or one
/// with a chain on top of itself. PDB2PQR would try to move them apart, for minutes to an hour.
/// @throws InputError  names the first two
void require_separate_atoms(const Molecule& molecule);

/// Refuses a molecule of coarse-grained beads: those of MARTINI (BB, SC1), and HADDOCK's of a shape (SHA), by the names
/// of more than half of its atoms; and one of C-alpha atoms or of a backbone alone.
/// @throws FormatError (beads: as atoms they have no shape to compare either), InputError
void require_all_atoms(const Molecule& molecule);

}  // namespace espdiff
