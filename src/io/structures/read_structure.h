// read_structure.h: molecules from PQR, PDB and mmCIF files, distinguished by content.
#pragma once

#include <string>

#include "base/molecule/structure_options.h"
#include "base/types.h"

namespace espdiff {

/// Reads one conformation. The format is found from the content: a PQR, PDB or mmCIF under any name, also packed by
/// gzip, is read as what it is. Atoms keep file order. Alternate locations: the one of highest mean occupancy in the
/// residue (the first on ties). Models: MODEL records; without them (PDB, PQR) atoms that continue after END are the
/// next model. Radii: the file's (PQR), otherwise Bondi's by element. Charges: the file's, otherwise none. Unit:
/// elementary charge.
/// @throws IoError (missing, directory, unreadable)
/// @throws FormatError (with line: bad number, NaN, short record, negative radius)
/// @throws InputError (no atoms, model out of range, format not read or not supported by this build, with remedy)
Molecule read_structure(const std::string& path, const StructureOptions& options = {});

/// Number of models in the file.
/// @throws as read_structure()
int count_models(const std::string& path);

}  // namespace espdiff
