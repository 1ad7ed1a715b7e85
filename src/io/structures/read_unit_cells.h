// read_unit_cells.h: the periodic cells of PQR and PDB files (CRYST1) and of NAMD's .xsc files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/molecule/unit_cell.h"
#include "io/structures/atom_records.h"

namespace espdiff {

/// The cell of each model of a PQR or PDB file: the last CRYST1 record before its atoms. None where there is no such
/// record or an edge is at most 1 A, which says that there is no cell. Linear in the length of the text.
/// @param text of the file, into which the models point
/// @throws FormatError (a CRYST1 record that cannot be read)
std::vector<std::optional<UnitCell>> read_unit_cells(std::string_view text, const std::vector<AtomModel>& models,
                                                     const std::string& path);

/// Centre and edges from the last line of a NAMD .xsc (or .xst) file: {o, a, b, c}.
/// @throws FormatError (no labels, a column missing), IoError
std::array<Vec3d, 4> read_xsc(const std::string& path);

}  // namespace espdiff
