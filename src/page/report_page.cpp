// report_page.cpp: puts a result's record, arrays and the embedded page together.
#include "page/report_page.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/surface_parts.h"
#include "page/assembled_page.h"
#include "page/page_arrays.h"
#include "page/page_texts.h"
#include "plot/automatic_range.h"
#include "report/metrics.h"
#include "report/pair_files.h"

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

// ---- surface --------------------------------------------------------------------------------------------------------

std::vector<double> coordinates(const std::vector<Vec3d>& positions) {
  std::vector<double> all;
  for (const Vec3d& p : positions) all.insert(all.end(), {p.x, p.y, p.z});
  return all;
}

Json quantities_json(PageArrays& arrays, const PairFiles& files) {
  Json list = Json::array();
  for (const SurfaceQuantity& quantity : surface_quantities(files)) {
    const std::vector<double>& values = quantity.values->values;
    Json json = arrays.add_numbers(values);
    json["name"] = quantity.values->name;
    json["label"] = quantity.label;
    json["unit"] = quantity.unit;
    json["signed"] = quantity.is_signed;
    json["range"] = automatic_limit({values.begin(), values.end()});
    list.push_back(std::move(json));
  }
  return list;
}

void add_surface(Json& page, PageArrays& arrays, const PairFiles& files) {
  const VtpContent& surface = files.surface;
  if (surface.triangles.size() > kMaxPageTriangles)
    throw InputError(files.prefix + ".vtp: " + std::to_string(surface.triangles.size()) +
                     " triangles; a page takes at most " + std::to_string(kMaxPageTriangles) +
                     ": compare with a larger " + option("grid-spacing"));
  page["n_vertices"] = surface.positions.size();
  page["positions"]["target"] = arrays.add_numbers(coordinates(surface.positions));
  page["positions"]["source"] = arrays.add_numbers(coordinates(superposed_source(files)));
  page["quantities"] = quantities_json(arrays, files);
  CountedTriangles triangles = counted_triangles(surface);
  const std::size_t n_counted = triangles.counted.size();
  triangles.counted.insert(triangles.counted.end(), triangles.rest.begin(), triangles.rest.end());
  page["triangles"] = arrays.add_triangles(triangles.counted);
  page["triangles"]["n_counted"] = n_counted;
  page["residue"] = arrays.add_integers(residues_of_vertices(files));
}

}  // namespace

std::string report_page(const std::string& prefix, const std::string& title) {
  if (page_texts().count("three.min.js") == 0)
    throw DeviceError(
        "this build cannot write pages: three.js was not found when it was configured (Debian: libjs-three)");
  const PairFiles files = read_pair_files(prefix);
  const Verdict verdict = verdict_of(files);
  Json page = {{"title", title.empty() ? title_of(files) : title},
               {"source", name_of_input(files, "source")},
               {"target", name_of_input(files, "target")}};
  page["verdict"] = {{"trustworthy", verdict.trustworthy},
                     {"text", verdict.text},
                     {"reasons", verdict.reasons},
                     {"parts", verdict.parts}};
  page["warnings"] = verdict.warnings;
  page["numbers"] = numbers_of(files.record, files.unit);
  page["residues"] = residues_of(files.residues);
  page["provenance"] = provenance_of(files);
  PageArrays arrays;
  add_surface(page, arrays, files);
  return assembled_page(page, arrays, "report.html",
                        {"three.min.js", "TrackballControls.js", "shared.js", "report.js"});
}

}  // namespace espdiff
