// plot_pair.h: what `espdiff plot` draws of a comparison, and what a trajectory draws by itself.
#pragma once

#include <cstddef>
#include <string>

#include "io/files/read_csv.h"
#include "plot/state_plot.h"

namespace espdiff::cli {

/// A result is named by its prefix or one of its files; the table of a comparison's residues is what is drawn of it.
std::string file_to_plot(const std::string& given);

/// Whether it is the OUT.residues.csv of a comparison.
bool is_pair_table(const CsvTable& table);

/// The residues of a comparison that have a mean in both states.
/// @param bars the `top` ones that differ most (0: all); otherwise all in file order
/// @param field whose means are drawn; empty for the potential
/// @throws InputError (shapes alone were compared, no such field)
StatePlot state_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title,
                     const std::string& field);

/// Whether it is the OUT.residues.csv or OUT.NAME.residues.csv of an ensemble of two groups.
bool is_ensemble_table(const CsvTable& table);

/// The means of both groups by residue. The groups' names and the unit come from the table and from the OUT.json beside
/// it. @param bars, top, title as state_plot()
StatePlot group_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title);

/// As `espdiff plot TABLE -o PICTURE`, of a trajectory's table.
/// @throws as line_plot_script(), write_picture()
void plot_frames(const std::string& table, const std::string& picture);

}  // namespace espdiff::cli
