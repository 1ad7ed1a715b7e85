// report_page.cpp: puts a result's record, arrays and the embedded page together.
#include "page/report_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "io/files/write_csv.h"
#include "page/assembled_page.h"
#include "page/page_arrays.h"
#include "page/page_molecule.h"
#include "page/page_surface.h"
#include "report/records/metrics.h"
#include "report/records/pair_files.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

// ---- numbers --------------------------------------------------------------------------------------------------------

Json row_of(const Metric& metric, const Json& record, const std::string& unit) {
  const Json::json_pointer place(metric.json_pointer());
  if (!record.contains(place) || !record.at(place).is_number()) return nullptr;
  const std::string shown_in = unit_of(metric, unit);
  return {{"label", metric.label},
          {"help", metric.help},
          {"value", formatted(metric, record.at(place).get<double>()) + (shown_in.empty() ? "" : ' ' + shown_in)}};
}

void add_section(Json& sections, const std::string& title, const Json& rows) {
  if (!rows.empty()) sections.push_back({{"title", title}, {"rows", rows}});
}

void add_part(Json& sections, const std::string& title, const std::string& part, const Json& record,
              const std::string& unit) {
  Json rows = Json::array();
  for (const Metric& metric : part_metrics(part)) {
    if (Json row = row_of(metric, record, unit); !row.is_null()) rows.push_back(std::move(row));
  }
  add_section(sections, title, rows);
}

Json numbers_of(const Json& record, const std::string& unit) {
  static const std::vector<std::pair<MetricSection, const char*>> titles = {
      {MetricSection::kPotential, "Potential, target - source"},
      {MetricSection::kShape, "Shape"},
      {MetricSection::kCertificate, "Certificate"},
      {MetricSection::kSuperposition, "Superposition"},
      {MetricSection::kSurface, "Surface"},
      {MetricSection::kMapping, "Mapping"}};
  Json sections = Json::array();
  for (const auto& [section, title] : titles) {
    Json rows = Json::array();
    for (const Metric& metric : metrics()) {
      if (metric.section != section || !metric.has_result()) continue;
      if (Json row = row_of(metric, record, unit); !row.is_null()) rows.push_back(std::move(row));
    }
    add_section(sections, title, rows);
  }
  if (record.contains("region") && record.at("region").is_object())
    add_part(sections, "Region", kRegionPart, record, unit);
  if (record.contains("fixed_patches")) {
    for (const auto& [name, patch] : record.at("fixed_patches").items())
      add_part(sections, "Patch " + name, name, record, unit);
  }
  return sections;
}

Json residues_of(const CsvTable& table) {
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    code = table.require("insertion_code"), name = table.require("residue_name");
  Json columns = Json::array(), names = Json::array(), rows = Json::array();
  const std::vector<ResidueColumn> shown = residue_columns(table);
  for (const ResidueColumn& column : shown) {
    const bool is_main = column.name == "mean_abs_difference" || column.name == "mean_signed_difference" ||
                         column.name == "mean_slip" || column.name == "mean_displacement";
    columns.push_back({{"label", column.label}, {"unit", column.unit}, {"main", is_main}});
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<std::string>& row = table.rows[r];
    names.push_back(row[chain] + (row[chain].empty() ? "" : ":") + row[name] + ' ' + row[number] + row[code]);
    Json cells = Json::array();
    for (const ResidueColumn& column : shown) cells.push_back(table.number(r, column.index));  // NaN is null in JSON
    rows.push_back(std::move(cells));
  }
  return {{"columns", columns}, {"names", names}, {"rows", rows}};
}

/// A text of a member, or a number with four digits; "-" without one.
std::string shown_member(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || found->is_null()) return "-";
  return found->is_number()   ? csv_number(found->get<double>(), 4)
         : found->is_string() ? found->get<std::string>()
                              : "-";
}

/// The causes of each reading: in words, and the residues that contribute most.
Json cause_tables(const Json& record) {
  Json tables = Json::array();
  const Json causes = record.value("causes", Json::array());
  for (const Json& reading : causes) {
    Json rows = Json::array();
    const Json largest = reading.value("largest", Json::array());
    for (const Json& residue : largest) {
      const std::string detail = residue.value("detail", "");
      std::string what = detail.empty() ? residue.value("kind", "") : detail;
      std::replace(what.begin(), what.end(), '_', ' ');
      rows.push_back(Json::array({shown_member(residue, "residue"), what, shown_member(residue, "source"),
                                  shown_member(residue, "target"), shown_member(residue, "difference")}));
    }
    const std::string unit = " [" + shown_member(reading, "unit") + ']';
    Json table = {
        {"title", "Causes of the difference, " + shown_member(reading, "reading")},
        {"help", with_capital(shown_member(reading, "in_words")) + ". " + shown_member(reading, "certainty")}};
    table["columns"] = Json::array(
        {"Residue", "What changed", "Source" + unit, "Target" + unit, "Contribution to the difference" + unit});
    table["rows"] = std::move(rows);
    tables.push_back(std::move(table));
  }
  return tables;
}

// ---- surface --------------------------------------------------------------------------------------------------------

/// Names of the two arrays whose sum an array is, to rounding; empty without such: a target's values are the source's
/// and the difference, and need no array of their own in a page.
std::vector<std::string> summands_of(const VtpContent& surface, const VtpNumbers& array) {
  const std::string ending = "_target", name = array.name;
  if (name.size() <= ending.size() || name.substr(name.size() - ending.size()) != ending) return {};
  const std::string stem = name.substr(0, name.size() - ending.size());
  const VtpNumbers* const source = find_array(surface.point_arrays, stem + "_source");
  const VtpNumbers* const difference = find_array(surface.point_arrays, stem + "_difference");
  if (source == nullptr || difference == nullptr || source->n_components != 1 || difference->n_components != 1)
    return {};
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double a = source->values[i], b = difference->values[i], sum = array.values[i];
    if (std::isfinite(a + b) != std::isfinite(sum)) return {};
    constexpr double kSingle = 1e-6;  // of the file's numbers
    if (std::isfinite(sum) && std::abs(a + b - sum) > kSingle * (std::abs(a) + std::abs(b) + std::abs(sum))) return {};
  }
  return {source->name, difference->name};
}

Json quantities_json(PageArrays& arrays, const PairFiles& files) {
  Json list = Json::array();
  for (const SurfaceQuantity& quantity : surface_quantities(files)) {
    const std::vector<std::string> summands = summands_of(files.surface, *quantity.values);
    if (summands.empty()) {
      list.push_back(page_quantity(arrays, *quantity.values, quantity.label, quantity.unit, quantity.is_signed));
    } else {
      list.push_back(quantity_texts(*quantity.values, quantity.label, quantity.unit, quantity.is_signed));
      list.back()["sum_of"] = summands;
    }
  }
  return list;
}

/// What is unmatched, and what is matched and not trusted.
PageMarks marks_of(const VtpContent& surface) {
  PageMarks marks{page_flags(surface, "no_counterpart"), std::vector<std::uint8_t>(surface.triangles.size(), 0)};
  for (const char* name : {"why", "corrupt"}) {
    const std::vector<std::uint8_t> flags = page_flags(surface, name);
    for (std::size_t t = 0; t < flags.size(); ++t)
      if (flags[t] != 0 && (marks.unmatched.empty() || marks.unmatched[t] == 0)) marks.untrusted[t] = 1;
  }
  return marks;
}

void add_surface(Json& page, PageArrays& arrays, const PairFiles& files) {
  const VtpContent& surface = files.surface;
  require_page_size(surface.triangles.size(), files.prefix);
  page["n_vertices"] = surface.positions.size();
  const std::vector<Vec3d> start = superposed_source(files);
  add_page_mesh(page, arrays, surface, start, marks_of(surface));
  page["positions"]["source"] = add_page_positions(arrays, start);
  page["quantities"] = quantities_json(arrays, files);
  add_page_reasons(page, arrays, surface);
  page["residue"] = arrays.add_integers(residues_of_vertices(files));
  page["fade"] = {{"name", "slip"}, {"from", 1}, {"to", 3}, {"text", "fainter where the mapping slips"}};
  page["linked"] = Json::array();
  for (const char* label : {"source", "target", "difference"})
    page["linked"].push_back(Json::array({std::string("potential_") + label, label}));
}

Json page_of(const PairFiles& files, const std::string& title, PageArrays& arrays) {
  const Verdict verdict = verdict_of(files);
  Json page = {{"title", title.empty() ? title_of(files) : title},
               {"states", "Source: " + name_of_input(files, "source") + ". Target: " + name_of_input(files, "target") +
                              ". Differences are target - source."}};
  page["verdict"] = {{"trustworthy", verdict.trustworthy},
                     {"text", verdict.text},
                     {"reasons", verdict.reasons},
                     {"parts", verdict.parts}};
  page["warnings"] = verdict.warnings;
  page["numbers"] = numbers_of(files.record, files.unit);
  page["tables"] = cause_tables(files.record);
  page["residues"] = residues_of(files.residues);
  page["provenance"] = provenance_of(files);
  add_surface(page, arrays, files);
  add_backbones(page, arrays, files.prefix);
  return page;
}

}  // namespace

std::string report_page(const std::string& prefix, const std::string& title, const std::vector<std::string>& range_of) {
  require_three();
  PageArrays arrays;
  Json page;
  try {
    page = page_of(read_pair_files(prefix), title, arrays);
  } catch (const Json::exception&) {
    throw FormatError(prefix + ".json", 0, "a part of it is not as `espdiff compare` writes it; compare again");
  }
  share_page_ranges(page, prefix, range_of);
  return assembled_page(page, arrays, "report.html", surface_page_scripts(), surface_page_library());
}

}  // namespace espdiff
