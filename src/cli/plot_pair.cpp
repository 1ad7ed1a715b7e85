// plot_pair.cpp: finds a comparison's table of residues, and takes both states' values from it.
#include "cli/plot_pair.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "cli/output_prefix.h"

namespace espdiff::cli {

bool is_pair_table(const CsvTable& table) { return table.find("residue_number") == 1 && table.find("area [A^2]") > 0; }

StatePlot state_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title,
                     const std::string& field) {
  StatePlot plot;
  std::size_t source = 0, target = 0, difference = 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c];
    const std::size_t bracket = name.find(" [");
    const std::string base = name.substr(0, bracket);
    const std::string of_field = field.empty() ? "" : field + "_";
    if (base == of_field + "mean_source") source = c;
    if (base == of_field + "mean_target") target = c;
    if (base != of_field + "mean_signed_difference") continue;
    difference = c;
    if (bracket != std::string::npos) plot.unit = name.substr(bracket + 2, name.size() - bracket - 3);
  }
  if (source == 0 || target == 0 || difference == 0)
    throw InputError(!field.empty() ? table.path + ": has no field '" + field + "'; compare with --field " + field
                                    : table.path + ": has no potentials of both states; compare with charges or maps");
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    name = table.require("residue_name"), insertion = table.require("insertion_code");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::vector<std::string>& cells = table.rows[row];
    StateBar bar{cells[name] + " " + cells[chain] + cells[number] + cells[insertion], table.number(row, difference),
                 table.number(row, source), table.number(row, target)};
    if (std::isfinite(bar.difference) && std::isfinite(bar.source) && std::isfinite(bar.target))
      plot.bars.push_back(std::move(bar));
  }
  if (bars && top > 0 && plot.bars.size() > top) {
    std::stable_sort(plot.bars.begin(), plot.bars.end(), [](const StateBar& l, const StateBar& r) {
      return std::fabs(l.difference) > std::fabs(r.difference);
    });
    plot.bars.resize(top);
  }
  plot.title = !title.empty()  ? title
               : bars          ? "Bars: target - source, mean " + (field.empty() ? "" : field + " ") + "of each residue"
               : field.empty() ? "Mean potential of each residue"
                               : "Mean of each residue: " + field;
  return plot;
}

std::string file_to_plot(const std::string& given) {
  const auto exists = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
  };
  const std::string prefix = result_prefix(given);
  const bool is_result = prefix != given || !exists(given);
  if (is_result && exists(prefix + ".residues.csv") && exists(prefix + ".vtp")) return prefix + ".residues.csv";
  if (prefix == given && !exists(given)) {
    if (exists(prefix + ".json")) return prefix + ".json";
    if (exists(prefix + ".csv")) return prefix + ".csv";
  }
  return given;
}

}  // namespace espdiff::cli
