// series_row.cpp: the table of columns, and rows from results.
#include "trajectory/series_row.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// A column, and where its value stands in OUT.json.
struct Column {
  const char* name;
  const char* pointer;
};

constexpr Column kColumns[] = {
    {"frame", ""},
    {"reference_frame", ""},
    {"rmsd_A", "/rmsd_A"},
    {"potential_unit", "/potential_unit"},
    {"mean_abs_difference", "/mean_abs_difference"},
    {"rms_difference", "/rms_difference"},
    {"mean_signed_difference", "/mean_signed_difference"},
    {"sign_change_area_fraction", "/sign_change_area_fraction"},
    {"hodgkin_index", "/hodgkin_index"},
    {"mean_displacement_A", "/mean_displacement_A"},
    {"area_mapped_A2", "/area_A2/mapped"},
    {"corrupt_area_fraction", "/certificate/corrupt_area_fraction"},
    {"flipped_area_fraction", "/certificate/flipped_area_fraction"},
    {"no_counterpart_source", "/certificate/no_counterpart_area_fraction/source"},
    {"no_counterpart_target", "/certificate/no_counterpart_area_fraction/target"},
    {"target_to_mapped_max_A", "/certificate/target_to_mapped_A/max"},
    {"converged", "/certificate/converged"},
    {"trustworthy", "/certificate/trustworthy"},
    {"start", "/start"},
    {"iterations", "/iterations"},
    {"reasons", "/certificate/reasons"},
    {"error", ""},
};

std::string cell_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_string()) return one_line(value.get<std::string>());
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& element : value) text += (text.empty() ? "" : "; ") + cell_of(element);
  return text;
}

std::size_t index_of(const std::string& column) {
  const auto& names = series_columns();
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

const std::vector<std::string>& series_columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Column& column : kColumns) all.emplace_back(column.name);
    return all;
  }();
  return names;
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
                     const CompareResult& result, const CompareOptions& options) {
  const Json json = Json::parse(compare_json(source, target, result, options, {}));
  for (const Column& column : kColumns)
    cells_.push_back(*column.pointer != '\0' ? cell_of(json.at(Json::json_pointer(column.pointer))) : std::string());
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const std::string& error)
    : cells_(series_columns().size()) {
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
  at("error") = one_line(error);
}

const std::string& SeriesRow::operator[](const std::string& column) const { return cells_.at(index_of(column)); }
std::string& SeriesRow::at(const std::string& column) { return cells_.at(index_of(column)); }

}  // namespace espdiff
