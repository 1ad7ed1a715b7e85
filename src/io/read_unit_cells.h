// read_unit_cells.h: the periodic cells of PQR and PDB files (CRYST1) and of NAMD's .xsc files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A cell by lengths and angles, as structure files give it.
struct UnitCell {
  Vec3d lengths{};  ///< Angstrom
  Vec3d angles{};   ///< degrees: between b and c, a and c, a and b
};

/// The cell of each model: the last CRYST1 record before its atoms. None where there is no such record or an edge is at
/// most 1 A, which says that there is no cell; none for files other than PQR and PDB.
/// @throws as read_structure(); FormatError (a CRYST1 record that cannot be read)
std::vector<std::optional<UnitCell>> read_unit_cells(const std::string& path);

/// Centre and edges from the last line of a NAMD .xsc (or .xst) file: {o, a, b, c}.
/// @throws FormatError (no labels, a column missing), IoError
std::array<Vec3d, 4> read_xsc(const std::string& path);

}  // namespace espdiff
