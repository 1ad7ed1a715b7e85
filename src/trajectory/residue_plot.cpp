// residue_plot.cpp: reads the table that ResidueCsv wrote.
#include "trajectory/residue_plot.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/files/read_csv.h"
#include "io/files/write_csv.h"
#include "report/records/metrics.h"
#include "trajectory/residue_csv.h"

namespace espdiff {

bool is_residue_table(const CsvTable& table) {
  return !table.comments.empty() && table.comments.front().rfind(ResidueCsv::kHeadWord, 0) == 0 &&
         table.columns.front() == "frame";
}

namespace {

/// [column] of the head; empty where it has none.
std::vector<std::string> partners_of(const CsvTable& table) {
  const std::string word = ResidueCsv::kPartners;
  const bool is_there = table.comments.size() > 2 && table.comments[2].rfind(word, 0) == 0;
  if (!is_there) return {};
  return parse_csv(csv_row(table.columns) + table.comments[2].substr(word.size()) + "\n", table.path).rows.at(0);
}

}  // namespace

FrameMap residue_map(const CsvTable& table) {
  const std::string head = table.comments.front().substr(std::string(ResidueCsv::kHeadWord).size());
  const std::size_t blank = std::min(head.find(' '), head.size());
  const Metric* const metric = metric_of_column(head.substr(0, blank));
  FrameMap map;
  map.title = metric == nullptr ? head.substr(0, blank) : metric->label;
  if (blank + 2 < head.size()) map.unit = head.substr(blank + 2, head.size() - blank - 3);
  double factor = 1;
  if (metric != nullptr) {
    const ShownUnit shown = shown_unit(*metric, map.unit);
    map.unit = shown.unit;
    factor = shown.factor;
  }
  if (map.unit == "A") map.unit = "\u00C5";
  if (map.unit == "A^2") map.unit = "\u00C5\u00B2";
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    map.frames.push_back(static_cast<int>(table.number(row, 0)));
  const std::vector<std::string> partners = partners_of(table);
  for (std::size_t column = 1; column < table.columns.size(); ++column) {
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows.size(); ++row) values.push_back(factor * table.number(row, column));
    if (std::none_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) continue;
    map.labels.push_back(table.columns[column]);
    if (!partners.empty()) map.partners.push_back(partners[column]);
    map.values.insert(map.values.end(), values.begin(), values.end());
  }
  if (map.labels.empty()) throw InputError(table.path + ": there is nothing to draw: no frame has a value");
  return map;
}

}  // namespace espdiff
