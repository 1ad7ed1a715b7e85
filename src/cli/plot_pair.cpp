// plot_pair.cpp: finds a comparison's tables of residues and causes, and takes what is drawn from them.
#include "cli/plot_pair.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "cli/output_prefix.h"
#include "io/text/text_cursor.h"

namespace espdiff::cli {
namespace {

/// Those that differ most; 0 keeps all in the table's order.
void keep_largest(StatePlot& plot, std::size_t top) {
  if (top == 0 || plot.bars.size() <= top) return;
  std::stable_sort(plot.bars.begin(), plot.bars.end(), [](const StateBar& l, const StateBar& r) {
    return std::fabs(l.difference) > std::fabs(r.difference);
  });
  plot.bars.resize(top);
}

/// Name and unit of what an ensemble compares, from the record beside its table; "potential" without one.
std::pair<std::string, std::string> quantity_of_ensemble(const std::string& table) {
  std::ifstream in(result_prefix(table) + ".json");
  const nlohmann::json record = nlohmann::json::parse(in, nullptr, false);
  if (!record.is_object()) return {"potential", ""};
  const auto text = [](const nlohmann::json& of, const char* key) {
    return of.is_object() && of.contains(key) && of[key].is_string() ? of[key].get<std::string>() : std::string();
  };
  const std::string name = record.contains("field") ? text(record["field"], "name") : "";
  return {name.empty() ? "potential" : name, text(record, "potential_unit")};
}

}  // namespace

bool is_pair_table(const CsvTable& table) { return table.find("residue_number") == 1 && table.find("area [A^2]") > 0; }

bool is_ensemble_table(const CsvTable& table) {
  return table.find("residue") == 0 && table.find("significant_area_A2") > 4;
}

StatePlot state_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title,
                     const std::string& field) {
  StatePlot plot;
  plot.has_bars = bars;
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
  if (bars) keep_largest(plot, top);
  plot.title = !title.empty()  ? title
               : bars          ? "Bars: target - source, mean " + (field.empty() ? "" : field + " ") + "of each residue"
               : field.empty() ? "Mean potential of each residue"
                               : "Mean of each residue: " + field;
  return plot;
}

StatePlot group_plot(const CsvTable& table, bool bars, std::size_t top, const std::string& title) {
  const std::string mean = "mean_";
  const std::size_t source = 2, target = 3, difference = table.require("difference");
  StatePlot plot;
  plot.has_bars = bars;
  plot.source = table.columns[source].substr(mean.size());
  plot.target = table.columns[target].substr(mean.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    StateBar bar{table.rows[row][0], table.number(row, difference), table.number(row, source),
                 table.number(row, target)};
    if (std::isfinite(bar.difference) && std::isfinite(bar.source) && std::isfinite(bar.target))
      plot.bars.push_back(std::move(bar));
  }
  if (bars) keep_largest(plot, top);
  const auto [quantity, unit] = quantity_of_ensemble(table.path);
  plot.unit = unit;
  plot.title = !title.empty() ? title
               : bars         ? "Bars: " + plot.target + " - " + plot.source + ", mean " + quantity + " of each residue"
                              : "Mean of each residue: " + quantity;
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

bool is_matrix_table(const CsvTable& table) { return table.find("source") >= 0 && table.find("target") >= 0; }

std::string matrix_json_of(const std::string& csv) {
  return std::filesystem::path(csv).replace_extension(".json").string();
}

PlotInput plot_input(const std::string& given) {
  PlotInput input{file_to_plot(given), false, {}};
  const auto is_json = [](const std::string& path) {
    return path.size() > 5 && lower_case(path).substr(path.size() - 5) == ".json";
  };
  if (!is_json(input.path)) {
    input.table = read_csv(input.path);
    std::error_code ignored;
    if (is_matrix_table(input.table) && std::filesystem::is_regular_file(matrix_json_of(input.path), ignored))
      input.path = matrix_json_of(input.path);
  }
  input.is_json = is_json(input.path);
  return input;
}

bool is_cause_table(const CsvTable& table) { return table.find("reading") == 0 && table.find("poorly_known") > 0; }

std::vector<CausePanel> cause_panels(const CsvTable& table) {
  constexpr std::size_t kMostBars = 12;
  std::size_t difference = 0;
  std::string unit;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c];
    const std::string start = "difference [";
    if (name.compare(0, start.size(), start) != 0) continue;
    difference = c;
    unit = name.substr(start.size(), name.size() - start.size() - 1);
  }
  if (difference == 0) throw FormatError(table.path, 0, "there is no column 'difference [UNIT]'");
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    name = table.require("residue_name"), kind = table.require("kind"),
                    uncertain = table.require("poorly_known"), insertion = table.require("insertion_code");
  std::vector<CausePanel> panels;
  std::vector<double> sums;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::vector<std::string>& cells = table.rows[row];
    if (panels.empty() || panels.back().title != cells[0]) {
      panels.push_back({cells[0], unit, {}});
      sums.push_back(0);
    }
    const double value = table.number(row, difference);
    sums.back() += value;
    if (panels.back().bars.size() == kMostBars) continue;
    std::string words = cells[kind];
    std::replace(words.begin(), words.end(), '_', ' ');
    const std::string residue = cells[name] + (cells[number].empty() ? "" : " " + cells[number]) + cells[insertion] +
                                (cells[chain].empty() ? "" : " " + cells[chain]);
    panels.back().bars.push_back({residue + ", " + words, value, cells[uncertain] == "1"});
  }
  for (std::size_t i = 0; i < panels.size(); ++i)
    panels[i].title += ": " + formatted("%+.3g", sums[i]) + " " + unit + "; pale: place poorly known";
  return panels;
}

std::string cause_table_of(const std::string& given) {
  const std::string ending = ".causes.csv";
  const bool is_table =
      given.size() > ending.size() && given.compare(given.size() - ending.size(), ending.size(), ending) == 0;
  const std::string path = is_table ? given : result_prefix(given) + ending;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": no such file; compare with --causes first, such as --causes whole");
  return path;
}

}  // namespace espdiff::cli
