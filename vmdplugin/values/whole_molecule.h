// whole_molecule.h: finds molecules of VMD that their periodic cell cuts, and makes them whole.
#pragma once

#include <string>

#include "base/molecule/unit_cell.h"
#include "base/types.h"

namespace espdiff::vmdplugin {

/// Puts the parts of a molecule together that lie in different images of its cell. The largest part stays where it is.
/// A molecule is cut where two neighbouring atoms of a chain are near each other only in another image.
/// @param make_whole false: throws if the molecule is cut
/// @param role       for messages: source, target
/// @returns the number of atoms that were moved; 0 if the molecule is not cut
/// @throws InputError (cut, and not to be made whole): how many atoms lie elsewhere, and the remedy
std::size_t make_whole(Molecule& molecule, const UnitCell& cell, bool make_whole, const std::string& role);

}  // namespace espdiff::vmdplugin
