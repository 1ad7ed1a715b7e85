// report_page.cpp: puts a result's record, arrays and the embedded page together.
#include "page/report_page.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/surface_parts.h"
#include "base/version.h"
#include "io/json_values.h"
#include "io/read_csv.h"
#include "io/read_input.h"
#include "io/read_vtp.h"
#include "page/page_arrays.h"
#include "page/page_texts.h"
#include "plot/automatic_range.h"
#include "plot/colour_map.h"
#include "report/metrics.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// A point array that the page colours the surface by.
struct PageQuantity {
  const char *array, *label;
  bool is_potential, is_signed;
};

const std::vector<PageQuantity>& usual_quantities() {
  static const std::vector<PageQuantity> quantities = {
      {"potential_difference", "Difference", true, true},
      {"potential_source", "Potential of the source", true, true},
      {"potential_target", "Potential of the target", true, true},
      {"sign_change", "Change of sign", false, false},
      {"slip", "Slip of the mapping", false, false},
      {"displacement", "Displacement", false, false},
  };
  return quantities;
}

Json read_record(const std::string& prefix) {
  const std::string path = prefix + ".json";
  const FileContent file = read_input(path);
  require_memory_for_json(file.content, path);
  Json record = Json::parse(file.content, nullptr, false);
  if (record.is_discarded() || !record.contains("certificate") || !record.contains("superposition"))
    throw FormatError(path, 0, "not a record that `espdiff compare` wrote; compare again");
  return record;
}

std::vector<std::string> texts_of(const Json& list) {
  std::vector<std::string> texts;
  for (const Json& item : list) {
    if (item.is_string()) texts.push_back(item.get<std::string>());
    if (item.is_object() && item.contains("text")) texts.push_back(item.at("text").get<std::string>());
  }
  return texts;
}

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

/// The metric of a column such as "mean_slip [A]", whose name may carry its unit.
const Metric* metric_of_column(const std::string& name) {
  for (const char* ending : {"", "_A", "_A2"}) {
    if (const Metric* metric = find_metric_or_null(name + ending)) return metric;
  }
  return nullptr;
}

Json residues_of(const std::string& path) {
  const CsvTable table = read_csv(path);
  const std::size_t chain = table.require("chain"), number = table.require("residue_number"),
                    code = table.require("insertion_code"), name = table.require("residue_name");
  Json columns = Json::array(), names = Json::array(), rows = Json::array();
  std::vector<std::size_t> shown;
  for (std::size_t c = name + 1; c < table.columns.size(); ++c) {
    const std::string& text = table.columns[c];
    const std::size_t bracket = text.find(" [");
    const std::string plain = text.substr(0, bracket);
    const Metric* const metric = metric_of_column(plain);
    const bool is_main = plain == "mean_abs_difference" || plain == "mean_signed_difference" || plain == "mean_slip" ||
                         plain == "mean_displacement";
    columns.push_back(
        {{"label", metric != nullptr ? metric->label : plain},
         {"unit", bracket == std::string::npos ? "" : text.substr(bracket + 2, text.size() - bracket - 3)},
         {"main", is_main}});
    shown.push_back(c);
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<std::string>& row = table.rows[r];
    names.push_back(row[chain] + (row[chain].empty() ? "" : ":") + row[name] + ' ' + row[number] + row[code]);
    Json cells = Json::array();
    for (const std::size_t c : shown) cells.push_back(table.number(r, c));  // NaN is null in JSON
    rows.push_back(std::move(cells));
  }
  return {{"columns", columns}, {"names", names}, {"rows", rows}};
}

Json provenance_of(const Json& record) {
  Json rows = Json::array();
  const auto add = [&](const std::string& name, const std::string& text) { rows.push_back({name, text}); };
  add("Command", record.value("command_line", ""));
  add("Program", "espdiff " + record.value("version", std::string()) + ", on " + record.value("device", "") + " (" +
                     record.value("device_description", "") + ")");
  for (const Json& input : record.value("inputs", Json::array())) {
    std::string text = input.value("path", "");
    if (input.contains("sha256")) text += ", SHA-256 " + input.value("sha256", "");
    add("Input: " + input.value("role", ""), text);
  }
  std::string options;
  const Json settings = record.value("options", Json::object());  // items() keeps a reference
  for (const auto& [name, value] : settings.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (!text.empty()) options += (options.empty() ? "" : ", ") + name + ' ' + text;
  }
  add("Options", options);
  return rows;
}

// ---- surface --------------------------------------------------------------------------------------------------------

/// The source's positions in the target's frame.
std::vector<double> superposed(const Json& record, const VtpNumbers& positions) {
  const Json& superposition = record.at("superposition");
  const auto rotation = superposition.at("rotation_row_major").get<std::vector<double>>();
  const auto translation = superposition.at("translation_A").get<std::vector<double>>();
  std::vector<double> out(positions.values.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t first = i - i % 3, row = i % 3;
    out[i] = translation[row];
    for (std::size_t k = 0; k < 3; ++k) out[i] += rotation[3 * row + k] * positions.values[first + k];
  }
  return out;
}

Json quantity_json(PageArrays& arrays, const VtpNumbers& array, const std::string& label, const std::string& unit,
                   bool is_signed) {
  Json quantity = arrays.add_numbers(array.values);
  quantity["name"] = array.name;
  quantity["label"] = label;
  quantity["unit"] = unit;
  quantity["signed"] = is_signed;
  quantity["range"] = automatic_limit({array.values.begin(), array.values.end()});
  return quantity;
}

Json quantities_of(PageArrays& arrays, const VtpContent& surface, const std::string& unit) {
  Json quantities = Json::array();
  for (const PageQuantity& usual : usual_quantities()) {
    const VtpNumbers* const array = find_array(surface.point_arrays, usual.array);
    if (array == nullptr) continue;
    const std::string name = usual.array;
    quantities.push_back(quantity_json(arrays, *array, usual.label,
                                       usual.is_potential      ? unit
                                       : name == "sign_change" ? ""
                                                               : "A",
                                       usual.is_signed));
  }
  for (const VtpNumbers& array : surface.point_arrays) {
    const bool is_usual = std::any_of(usual_quantities().begin(), usual_quantities().end(),
                                      [&](const PageQuantity& usual) { return array.name == usual.array; });
    if (!is_usual && array.n_components == 1 && array.name.rfind("residue_", 0) != 0)
      quantities.push_back(quantity_json(arrays, array, array.name, "", true));
  }
  return quantities;
}

const VtpNumbers& required_array(const VtpContent& surface, const std::string& name, const std::string& path) {
  const VtpNumbers* const array = find_array(surface.point_arrays, name);
  if (array == nullptr)
    throw FormatError(path, 0, "has no point array '" + name + "'; compare again with this version of espdiff");
  return *array;
}

/// The trusted triangles, then the others.
std::vector<Triangle> counted_first(const VtpContent& surface, std::size_t& n_counted) {
  std::vector<Triangle> counted, rest;
  const VtpNumbers* const why = find_array(surface.cell_arrays, "why");
  const VtpNumbers* const corrupt = find_array(surface.cell_arrays, "corrupt");
  const VtpNumbers* const unmatched = find_array(surface.cell_arrays, "no_counterpart");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const bool is_counted = (why == nullptr || why->values[t] == 0) &&
                            (corrupt == nullptr || corrupt->values[t] == 0) &&
                            (unmatched == nullptr || unmatched->values[t] == 0);
    (is_counted ? counted : rest).push_back(surface.triangles[t]);
  }
  n_counted = counted.size();
  counted.insert(counted.end(), rest.begin(), rest.end());
  return counted;
}

void add_surface(Json& page, PageArrays& arrays, const Json& record, const std::string& path, const std::string& unit) {
  const VtpContent surface = read_vtp(path);
  if (surface.triangles.size() > kMaxPageTriangles)
    throw InputError(path + ": " + std::to_string(surface.triangles.size()) + " triangles; a page takes at most " +
                     std::to_string(kMaxPageTriangles) + ": compare with a larger " + option("grid-spacing"));
  std::vector<double> positions, residues;
  for (const Vec3d& p : surface.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
  page["n_vertices"] = surface.positions.size();
  page["positions"]["target"] = arrays.add_numbers(positions);
  page["positions"]["source"] =
      arrays.add_numbers(superposed(record, required_array(surface, "source_position", path)));
  page["quantities"] = quantities_of(arrays, surface, unit);
  std::size_t n_counted = 0;
  page["triangles"] = arrays.add_triangles(counted_first(surface, n_counted));
  page["triangles"]["n_counted"] = n_counted;
  std::vector<std::int32_t> residue;
  for (const double index : required_array(surface, "residue_index", path).values)
    residue.push_back(static_cast<std::int32_t>(index));
  page["residue"] = arrays.add_integers(residue);
}

Json colour(Rgb rgb) { return {rgb.red, rgb.green, rgb.blue}; }

void add_scales(Json& page) {
  constexpr int kColours = 255;
  Json names = {"red-blue", "cool-warm", "purple-orange"}, scales = Json::object();
  for (const Json& name : names) {
    const DivergingMap& map = diverging_map(name.get<std::string>());
    Json& scale = scales[name.get<std::string>()] = Json::array();
    for (int i = 0; i < kColours; ++i) scale.push_back(colour(diverging_colour(i / (kColours - 1.0), map)));
  }
  Json& magnitude = scales["magnitude"] = Json::array();
  for (int i = 0; i < kColours; ++i) magnitude.push_back(colour(sequential_colour(i / (kColours - 1.0))));
  page["diverging"] = std::move(names);
  page["scales"] = std::move(scales);
  page["no_value"] = colour(kNoValueColour);
}

// ---- page -----------------------------------------------------------------------------------------------------------

std::string name_of_input(const Json& record, const std::string& role) {
  for (const Json& input : record.value("inputs", Json::array())) {
    if (input.value("role", "") == role) return std::filesystem::path(input.value("path", "")).filename().string();
  }
  return role;
}

/// JSON that cannot end the script element it stands in.
std::string embedded(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

std::string assembled(const Json& page, const std::string& arrays) {
  const auto& files = page_texts();
  const auto script = [&](const char* name) { return "<script>\n" + files.at(name) + "\n</script>\n"; };
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\">\n"
         // Nothing is fetched, whatever the texts of a result hold.
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
         "style-src 'unsafe-inline'; img-src data: blob:\">\n<title>espdiff</title>\n<style>\n" +
         files.at("report.css") + "</style>\n</head>\n<body>\n" + files.at("report.html") +
         "<noscript>This page draws by JavaScript and WebGL.</noscript>\n"
         "<script type=\"application/json\" id=\"record\">" +
         embedded(page) + "</script>\n<script type=\"application/octet-stream\" id=\"arrays\">" + arrays +
         "</script>\n" + script("three.min.js") + script("TrackballControls.js") + script("report.js") +
         "</body>\n</html>\n";
}

}  // namespace

std::string report_page(const std::string& prefix, const std::string& title) {
  if (page_texts().count("three.min.js") == 0)
    throw DeviceError(
        "this build cannot write pages: three.js was not found when it was configured (Debian: libjs-three)");
  const Json record = read_record(prefix);
  const std::string unit = record.value("potential_unit", Json()).is_string() ? record.at("potential_unit") : "";
  const Json& certificate = record.at("certificate");
  const bool trustworthy = certificate.value("trustworthy", false);
  const std::string source = name_of_input(record, "source"), target = name_of_input(record, "target");
  Json page = {
      {"title", title.empty() ? target + " against " + source : title}, {"source", source}, {"target", target}};
  page["verdict"] = {{"trustworthy", trustworthy},
                     {"text", certificate.value("verdict", trustworthy ? "TRUSTWORTHY" : "NOT TRUSTWORTHY")},
                     {"parts", texts_of(certificate.value("untrusted_parts", Json::array()))},
                     {"reasons", texts_of(certificate.value("reasons", Json::array()))}};
  page["warnings"] = texts_of(record.value("warnings", Json::array()));
  page["numbers"] = numbers_of(record, unit);
  page["residues"] = residues_of(prefix + ".residues.csv");
  page["provenance"] = provenance_of(record);
  add_scales(page);
  PageArrays arrays;
  add_surface(page, arrays, record, prefix + ".vtp", unit);
  page["deflated"] = PageArrays::is_deflated();
  return assembled(page, arrays.base64());
}

}  // namespace espdiff
