// plot_pair.h: what `espdiff plot` draws of a comparison.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/files/read_csv.h"
#include "plot/cause_plot.h"
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

/// Whether it is the OUT.csv of a matrix, and the OUT.json beside it.
bool is_matrix_table(const CsvTable& table);
std::string matrix_json_of(const std::string& csv);

/// A file that is drawn, and its content where it is a table.
struct PlotInput {
  std::string path;
  bool is_json = false;
  CsvTable table;
};

/// A matrix is drawn from its JSON file, whichever file is given. @throws as read_csv()
PlotInput plot_input(const std::string& given);

/// Whether it is the OUT.causes.csv of a comparison.
bool is_cause_table(const CsvTable& table);
/// A panel for each reading, with its largest contributions. @throws FormatError (no column of differences)
std::vector<CausePanel> cause_panels(const CsvTable& table);
/// The table of a result's causes, whichever of its files is given. @throws InputError (there is none)
std::string cause_table_of(const std::string& given);

/// Whether it is the OUT.residues.csv or OUT.NAME.residues.csv of an ensemble of two groups.
bool is_ensemble_table(const CsvTable& table);

/// The means of both groups by residue. The groups' names and the unit come from the table and from the OUT.json beside
/// it. @param bars, top, title as state_plot()
StatePlot group_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title);

}  // namespace espdiff::cli
