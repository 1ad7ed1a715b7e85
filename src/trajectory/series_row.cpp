// series_row.cpp: table of columns; makes rows from results.
#include "trajectory/series_row.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "certificate/region_result.h"
#include "certificate/result.h"
#include "report/compare_json.h"
#include "report/records/metrics.h"
#include "report/sections/provenance.h"

namespace espdiff {
namespace {

using OrderedJson = nlohmann::ordered_json;

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
  add({{"converged", "/certificate/converged"},
       {"trustworthy", "/certificate/trustworthy"},
       {"start", "/start"},
       {"domains", "/motions/domains"}});
  add(of_mapping);
  add({{"reasons", "/certificate/reasons"}, {"warnings", "/warnings"}, {"error", ""}});
  return all;
}

/// The same of a region or patch, with its verdict.
void add_columns_of_part(const std::string& part, std::vector<Column>& all) {
  for (const Metric& metric : part_metrics(part)) {
    if ((metric.flags & kInSeries) != 0) all.push_back({metric.name, metric.json_pointer()});
  }
  all.push_back({part + "_trustworthy", part_pointer(part) + "/certificate/trustworthy"});
  all.push_back({part + "_reasons", part_pointer(part) + "/certificate/reasons"});
}

struct Columns {
  std::vector<Column> table;
  std::vector<std::string> names;
};

/// Made once for each choice.
const Columns& columns_for(const PartsAndFields& compared) {
  static std::mutex one_at_a_time;
  static std::map<PartsAndFields, Columns> known;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  Columns& columns = known[compared];
  if (!columns.table.empty()) return columns;
  columns.table = make_columns();
  for (const std::string& part : compared.parts) add_columns_of_part(part, columns.table);
  for (const Metric& metric : all_field_metrics(compared)) {
    if ((metric.flags & kInSeries) != 0) columns.table.push_back({metric.name, metric.json_pointer()});
  }
  for (const Column& column : columns.table) columns.names.push_back(column.name);
  return columns;
}

std::string cell_of(const OrderedJson& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_string()) return one_line(value.get<std::string>());
  if (value.is_object()) return one_line(value.value("text", ""));  // a warning
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const OrderedJson& element : value) text += (text.empty() ? "" : "; ") + cell_of(element);
  return text;
}

/// The value in OUT.json; null where it is part of what was not checked, which is null as a whole.
const OrderedJson& value_at(const OrderedJson& json, const std::string& pointer) {
  const OrderedJson::json_pointer at(pointer);
  const OrderedJson& parent = json.at(at.parent_pointer());
  return parent.is_null() ? parent : json.at(at);
}

}  // namespace

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

const std::vector<std::string>& series_columns(const PartsAndFields& compared) { return columns_for(compared).names; }

SeriesRow::SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
                     const CompareResult& result, const CompareOptions& options)
    : columns_(&series_columns(parts_and_fields(result))) {
  const OrderedJson json = compare_json(source, target, result, options, {});
  for (const Column& column : columns_for(parts_and_fields(result)).table)
    cells_.push_back(column.pointer.empty() ? std::string() : cell_of(value_at(json, column.pointer)));
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const std::string& error, const PartsAndFields& compared)
    : columns_(&series_columns(compared)), cells_(columns_->size()) {
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
  at("error") = one_line(error);
}

std::size_t SeriesRow::index_of(const std::string& column) const {
  const auto found = std::find(columns_->begin(), columns_->end(), column);
  if (found == columns_->end())
    throw Error(ErrorClass::kInternal, "a trajectory's rows have no column '" + column + "'");
  return static_cast<std::size_t>(found - columns_->begin());
}

const std::string& SeriesRow::operator[](const std::string& column) const { return cells_.at(index_of(column)); }
std::string& SeriesRow::at(const std::string& column) { return cells_.at(index_of(column)); }

}  // namespace espdiff
