// write_cif.h: a molecule as an mmCIF file, with a value of one's own on every atom.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A category of one's own beside the atoms: a loop of texts.
struct CifLoop {
  std::string category;                        ///< "_espdiff_residue"
  std::vector<std::string> items;              ///< their names, in letters, digits and underscores
  std::vector<std::vector<std::string>> rows;  ///< [row][item]; empty texts are written as unknown ("?")
};

/// A text as one value of a CIF file: quoted where it has to be. Characters beyond ASCII's printable ones become '?'.
std::string cif_value(const std::string& text);
/// A name of an item: what is no letter, digit or underscore becomes an underscore.
std::string cif_name(const std::string& text);

/// Writes one block with `_atom_site` (PDBx/mmCIF) and the loops. The values are `B_iso_or_equiv`, unknown where NaN.
/// Chains are `auth_asym_id` and `label_asym_id`; a molecule's residues of ATOM records are numbered along each chain
/// as `label_seq_id`.
/// @param values [atom]
/// @param notes  comments above the loops, one line each
/// @throws InputError (a number of values that is not that of the atoms)
void write_cif(std::ostream& out, const std::string& block, const Molecule& molecule, const std::vector<double>& values,
               const std::vector<std::string>& notes, const std::vector<CifLoop>& loops);

}  // namespace espdiff
