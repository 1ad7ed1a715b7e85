// pdb_text.h: checks the atom lines of a PDB file and prepares them for a parser that forgives too much.
#pragma once

#include <string>
#include <vector>

#include "io/molecules/molecule_builder.h"
#include "io/structures/atom_records.h"

namespace espdiff {

/// Atom lines that passed the checks, as text of their own.
struct CheckedPdb {
  std::string text;             ///< 80 columns a line, without formal charges; serial numbers replaced by 1, 2, 3, ...
  std::vector<AtomLine> lines;  ///< [serial - 1], the original lines
};

/// Columns 18 to 20, and column 21 as the name's fourth letter (TIP3, POPC) unless the three are a standard residue.
std::string pdb_residue_name(const AtomLine& line);

/// Column 22, with column 21 in front of it when that is not part of the residue's name.
std::string pdb_chain_name(const AtomLine& line);

/// Whether columns 77 and 78 hold a letter.
bool has_pdb_element(const AtomLine& line);

/// Checks and copies the lines that `builder` wants.
/// @throws FormatError (shorter than 54 columns, tabs, coordinates or residue numbers that are not numbers)
CheckedPdb check_pdb(const std::string& path, const AtomModel& model, MoleculeBuilder& builder);

}  // namespace espdiff
