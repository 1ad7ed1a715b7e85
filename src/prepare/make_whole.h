// make_whole.h: molecules that a periodic cell's border has cut.
#pragma once

#include <cstddef>
#include <string>

#include "base/molecule/unit_cell.h"
#include "base/types.h"

namespace espdiff {

/// Moves atoms by whole edges of a cell so that the chains are whole, see unwrapped(), if a bond crosses the border:
/// between residues of a chain that follow each other (C and N, O3' and P), or within a residue. Without such a bond
/// nothing moves, so that crystals stay as they are.
/// @returns the number of such bonds
std::size_t make_whole(Molecule& molecule, const UnitCell& cell);

/// "crossed the border of its periodic cell at 4 bonds, and was made whole"
std::string made_whole_in_words(std::size_t n_bonds);

}  // namespace espdiff
