// series_row.cpp: table of columns; makes rows from results.
#include "trajectory/series_row.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "compare/result.h"
#include "report/metrics.h"
#include "report/provenance.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// A column, and where its value stands in OUT.json; "" where it is in none.
struct Column {
  std::string name, pointer;
};

/// The metrics of a series stand between what names the row and how it came about, those of the mapping after them;
/// the potential's unit before the first metric of potentials.
std::vector<Column> make_columns() {
  std::vector<Column> all = {{"frame", ""}, {"reference_frame", ""}}, of_mapping;
  bool has_unit = false;
  for (const Metric& metric : metrics()) {
    if ((metric.flags & kInSeries) == 0) continue;
    const bool is_of_potential = metric.section == MetricSection::kPotential;
    if (is_of_potential && !has_unit) all.push_back({"potential_unit", "/potential_unit"});
    has_unit = has_unit || is_of_potential;
    (metric.section == MetricSection::kMapping ? of_mapping : all).push_back({metric.name, metric.json_pointer()});
  }
  const auto add = [&all](const std::vector<Column>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add({{"converged", "/certificate/converged"}, {"trustworthy", "/certificate/trustworthy"}, {"start", "/start"}});
  add(of_mapping);
  add({{"reasons", "/certificate/reasons"}, {"warnings", "/warnings"}, {"error", ""}});
  return all;
}

/// The same of the region, with its verdict.
std::vector<Column> make_columns_of_region() {
  std::vector<Column> all;
  for (const Metric& metric : region_metrics()) {
    if ((metric.flags & kInSeries) != 0) all.push_back({metric.name, metric.json_pointer()});
  }
  all.push_back({"region_trustworthy", "/region/certificate/trustworthy"});
  all.push_back({"region_reasons", "/region/certificate/reasons"});
  return all;
}

const std::vector<Column>& table_of_columns(bool with_region) {
  static const std::vector<Column> all = make_columns();
  static const std::vector<Column> with = [] {
    std::vector<Column> both = all;
    for (const Column& column : make_columns_of_region()) both.push_back(column);
    return both;
  }();
  return with_region ? with : all;
}

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_string()) return one_line(value.get<std::string>());
  if (value.is_object()) return one_line(value.value("text", ""));  // a warning
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& element : value) text += (text.empty() ? "" : "; ") + cell_of(element);
  return text;
}

/// The value in OUT.json; null where it is part of what was not checked, which is null as a whole.
const Json& value_at(const Json& json, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  const Json& parent = json.at(at.parent_pointer());
  return parent.is_null() ? parent : json.at(at);
}

std::size_t index_of(const std::string& column) {
  const auto& names = series_columns(true);
  const auto found = std::find(names.begin(), names.end(), column);
  if (found == names.end()) throw Error(ErrorClass::kInternal, "a trajectory's rows have no column '" + column + "'");
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

const std::vector<std::string>& series_columns(bool with_region) {
  static const std::vector<std::string> names = names_of(table_of_columns(false)),
                                        with = names_of(table_of_columns(true));
  return with_region ? with : names;
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
                     const CompareResult& result, const CompareOptions& options) {
  const Json json = compare_json(source, target, result, options, {});
  for (const Column& column : table_of_columns(result.region != nullptr))
    cells_.push_back(column.pointer.empty() ? std::string() : cell_of(value_at(json, column.pointer)));
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const std::string& error, bool with_region)
    : cells_(series_columns(with_region).size()) {
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
  at("error") = one_line(error);
}

const std::vector<std::string>& SeriesRow::columns() const {
  return series_columns(cells_.size() > series_columns().size());
}

const std::string& SeriesRow::operator[](const std::string& column) const { return cells_.at(index_of(column)); }
std::string& SeriesRow::at(const std::string& column) { return cells_.at(index_of(column)); }

}  // namespace espdiff
