// read_gemmi.h: molecules from PDB and mmCIF files, parsed by gemmi; errors in a build without it.
#pragma once

#include <string>

#include "base/error.h"
#include "base/molecule/structure_options.h"
#include "base/types.h"
#include "io/structures/atom_records.h"

namespace espdiff {

/// Reads one model of a PDB file. Lines are checked before gemmi sees them, since it takes what it cannot read for 0.
/// Of an atom with alternate locations one is kept: that of the location with the highest mean occupancy in the residue
/// (the first on ties), or, where the atom lacks that, its own of highest occupancy. An atom given twice at the same
/// place is kept once. A letter in column 21 is the fourth of the residue's name (TIP3, as CHARMM and VMD write it),
/// behind a standard residue the first of a chain name of two. Elements: columns 77 and 78, otherwise guessed from the
/// name.
/// @param remarks the file's REMARK 350 lines, which describe its assemblies
/// @throws FormatError (with line), InputError (no atoms left, no such assembly)
Molecule read_pdb(const std::string& path, const AtomModel& model, const std::string& remarks,
                  const StructureOptions& options);

/// Reads one model of an mmCIF file; author's names and numbers, alternate locations as for PDB.
/// @throws FormatError (syntax, coordinates that are not numbers), InputError (no atoms, columns or model)
Molecule read_mmcif(const std::string& path, const std::string& text, const StructureOptions& options);

/// Number of models in an mmCIF file. @throws FormatError, InputError as read_mmcif()
int count_mmcif_models(const std::string& path, const std::string& text);

#ifndef ESPDIFF_HAVE_GEMMI
[[noreturn]] inline void lack_gemmi(const std::string& path, const char* format) {
  throw InputError(
      path + ": this is a " + format +
      " file, and this build lacks the PDB and mmCIF reader; build espdiff with gemmi (Debian: gemmi-dev), "
      "or give a PQR file");
}
inline Molecule read_pdb(const std::string& path, const AtomModel&, const std::string&, const StructureOptions&) {
  lack_gemmi(path, "PDB");
}
inline Molecule read_mmcif(const std::string& path, const std::string&, const StructureOptions&) {
  lack_gemmi(path, "mmCIF");
}
inline int count_mmcif_models(const std::string& path, const std::string&) { lack_gemmi(path, "mmCIF"); }
#endif

}  // namespace espdiff
