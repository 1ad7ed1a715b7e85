// residue_plot.h: the residues of a trajectory as a picture.
#pragma once

#include <string>

#include "plot/frame_map.h"

namespace espdiff {

struct CsvTable;

/// Whether a table is a trajectory's table of residues (ResidueCsv).
bool is_residue_table(const CsvTable& table);

/// The residues that have a value in some frame. @throws FormatError, InputError (there is none)
FrameMap residue_map(const CsvTable& table);

}  // namespace espdiff
