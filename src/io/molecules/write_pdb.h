// write_pdb.h: a molecule as a PDB file, with a value of one's own on every atom.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Writes ATOM and HETATM records (PDB format 3.3) with the values as B factors. Occupancy is 1, or 0 where the value
/// is NaN, which is written as 0.00. What a column cannot hold of names and numbers is cut: serial numbers above 99999
/// and residue numbers above 9999 begin again at 0; a chain of several letters gives its first one, and its first four
/// stand in the columns of the segment.
/// @param values  [atom]
/// @param remarks lines of REMARK 99, of at most 68 characters
/// @throws InputError (a number of values that is not that of the atoms; a value that is not -99.99 to 999.99; a
/// position
///         beyond 8.3 digits), naming the atom
void write_pdb(std::ostream& out, const Molecule& molecule, const std::vector<double>& values,
               const std::vector<std::string>& remarks);

}  // namespace espdiff
