// study_page.cpp: the record and the arrays of a trajectory's or a matrix's page.
#include "page/study_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/text/citation.h"
#include "io/files/read_csv.h"
#include "io/files/read_input.h"
#include "io/text/json_values.h"
#include "page/assembled_page.h"
#include "page/page_arrays.h"
#include "plot/automatic_range.h"
#include "report/records/metrics.h"
#include "report/records/pair_files.h"
#include "report/sections/field_json.h"

namespace espdiff {
namespace {

using StudyJson = nlohmann::ordered_json;

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

/// The cell of a column that may be missing.
std::string cell(const CsvTable& table, std::size_t row, const char* column) {
  const int c = table.find(column);
  return c < 0 ? "" : table.rows[row][static_cast<std::size_t>(c)];
}

std::string potential_unit_in(const CsvTable& table) {
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (const std::string unit = cell(table, row, "potential_unit"); !unit.empty()) return unit;
  }
  return "";
}

/// Every column that is a metric and has a number, in the order of the file.
/// @param fields whose columns there are
StudyJson metric_columns(PageArrays& arrays, const CsvTable& table, const std::vector<Quantity>& fields,
                         const std::vector<std::size_t>& places, std::size_t n_places) {
  StudyJson list = StudyJson::array();
  const std::string unit = potential_unit_in(table);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Metric* const metric = metric_of_column(table.columns[c], fields);
    if (metric == nullptr || (*metric->part != '\0' && *metric->field == '\0')) continue;
    const ShownUnit shown = shown_unit(*metric, unit);
    std::vector<double> values(n_places, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t row = 0; row < table.rows.size(); ++row) values[places[row]] = shown.factor * table.number(row, c);
    const bool has_any = std::any_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    if (!has_any) continue;
    const bool is_signed = std::any_of(values.begin(), values.end(), [](double x) { return x < 0; });
    StudyJson json = arrays.add_singles(values);
    json["name"] = metric->name;
    json["label"] = metric->label;
    json["help"] = metric->help;
    json["unit"] = shown.unit;
    json["signed"] = is_signed;
    json["range"] = automatic_limit({values.begin(), values.end()}, 100);
    list.push_back(std::move(json));
  }
  if (list.empty()) throw FormatError(table.path, 0, "no column holds a metric of this version of espdiff");
  return list;
}

/// By place: whether it can be trusted (null: not computed), and what is said of it.
void add_remarks(StudyJson& page, const CsvTable& table, const std::vector<std::size_t>& places, std::size_t n_places) {
  StudyJson trust = StudyJson::array(), remarks = StudyJson::object();
  for (std::size_t i = 0; i < n_places; ++i) trust.push_back(nullptr);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string trustworthy = cell(table, row, "trustworthy");
    if (!trustworthy.empty()) trust[places[row]] = trustworthy != "0";
    for (const char* column : {"error", "reasons", "warnings"}) {
      const std::string text = cell(table, row, column);
      if (text.empty()) continue;
      StudyJson& said = remarks[std::to_string(places[row])];
      // A warning that refuses a frame is its reason, too.
      if (std::find(said.begin(), said.end(), text) == said.end()) said.push_back(text);
    }
  }
  page["trust"] = std::move(trust);
  page["remarks"] = std::move(remarks);
}

void add_summary(StudyJson& page, const std::string& what) {
  std::size_t n = 0, n_trusted = 0;
  for (const StudyJson& one : page.at("trust")) {
    if (!one.is_boolean()) continue;
    ++n;
    n_trusted += one.get<bool>() ? 1 : 0;
  }
  page["verdict"] = {{"trustworthy", n_trusted == n},
                     {"text", std::to_string(n_trusted) + " of " + std::to_string(n) + ' ' + what + " are trustworthy"},
                     {"reasons", StudyJson::array()}};
  page["warnings"] = StudyJson::array();
}

void require_rows(const CsvTable& table) {
  if (table.rows.empty()) throw FormatError(table.path, 0, "there are no rows");
  if (table.rows.size() > kMaxStudyRows)
    throw InputError(table.path + ": " + std::to_string(table.rows.size()) + " rows; a page takes at most " +
                     std::to_string(kMaxStudyRows));
}

// ---- matrix ---------------------------------------------------------------------------------------------------------

/// The order of the clustering as positions; empty if the record has none.
StudyJson clustered_order(const StudyJson& record, const std::map<std::string, std::size_t>& position) {
  StudyJson order = StudyJson::array();
  const StudyJson::json_pointer place("/clustering/order");
  if (!record.contains(place) || !record.at(place).is_array()) return order;
  for (const StudyJson& label : record.at(place)) {
    const auto found = label.is_string() ? position.find(label.get<std::string>()) : position.end();
    if (found != position.end()) order.push_back(found->second);
  }
  return order.size() == position.size() ? order : StudyJson::array();
}

void add_matrix(StudyJson& page, PageArrays& arrays, const std::string& prefix) {
  const StudyJson record = read_study_json(prefix + ".json");
  require_format_version(record, prefix + ".json");
  const CsvTable table = read_csv(prefix + ".csv");
  require_rows(table);
  const std::size_t source = table.require("source"), target = table.require("target");
  std::map<std::string, std::size_t> position;
  StudyJson labels = StudyJson::array(), provenance = StudyJson::array();
  for (const StudyJson& variant : record.at("variants")) {
    const std::string label = variant.value("label", "");
    position.emplace(label, labels.size());
    labels.push_back(label);
    for (const StudyJson& input : variant.value("inputs", StudyJson::array()))
      provenance.push_back({"Input: " + label, input.value("path", "") + ", SHA-256 " + input.value("sha256", "")});
  }
  const std::vector<Quantity> fields = quantities_of(parse_fields_json(record.value("fields", StudyJson::object())));
  const std::size_t n = labels.size();
  std::vector<std::size_t> places;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto s = position.find(table.rows[row][source]), t = position.find(table.rows[row][target]);
    if (s == position.end() || t == position.end())
      throw FormatError(table.path, table.lines[row], "names a variant that " + prefix + ".json does not have");
    places.push_back(s->second * n + t->second);
  }
  page["labels"] = std::move(labels);
  page["order"] = clustered_order(record, position);
  page["metrics"] = metric_columns(arrays, table, fields, places, n * n);
  add_remarks(page, table, places, n * n);
  add_summary(page, "pairs");
  const StudyJson program = {"Program", "espdiff " + record.value("version", "")};
  provenance.insert(provenance.begin(), program);
  provenance.push_back({"Options", options_of(record)});
  provenance.push_back({"How to cite", citation_of(record.value("version", ""))});
  page["provenance"] = std::move(provenance);
  page["states"] = std::to_string(n) + " variants; each row is a source, each column a target";
}

// ---- trajectory -----------------------------------------------------------------------------------------------------

/// The table of residues, a row of numbers for each residue; null if the file is not there.
StudyJson residue_rows(PageArrays& arrays, const std::string& path, const std::vector<std::string>& frames) {
  if (!exists(path)) return nullptr;
  const CsvTable table = read_csv(path);
  const std::size_t frame = table.require("frame");
  const std::string start = "residues: ";
  std::string label = "Residues";
  for (const std::string& comment : table.comments) {
    const std::size_t at = comment.find(start);
    if (at != std::string::npos && at < 2) label = comment.substr(at + start.size());
  }
  std::map<std::string, std::size_t> row_of;
  for (std::size_t row = 0; row < table.rows.size(); ++row) row_of[table.rows[row][frame]] = row;
  StudyJson names = StudyJson::array();
  std::vector<double> values;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c == frame) continue;
    names.push_back(table.columns[c]);
    for (const std::string& one : frames) {
      const auto found = row_of.find(one);
      values.push_back(found == row_of.end() ? std::numeric_limits<double>::quiet_NaN()
                                             : table.number(found->second, c));
    }
  }
  StudyJson json = arrays.add_singles(values);
  json["signed"] = std::any_of(values.begin(), values.end(), [](double x) { return x < 0; });
  json["range"] = automatic_limit({values.begin(), values.end()});
  const std::size_t bracket = label.find(" [");
  const Metric* const metric = metric_of_column(label.substr(0, bracket));
  if (metric != nullptr) label = metric->label + (bracket == std::string::npos ? "" : label.substr(bracket));
  json["label"] = label;
  json["names"] = std::move(names);
  return json;
}

/// The lines "name: text" above a trajectory's rows, in words; an empty text is left out, of options it means defaults.
StudyJson trajectory_provenance(const std::vector<std::string>& head) {
  static const std::map<std::string, std::string> words = {{"espdiff", "Program"},
                                                           {"file", "Frames from"},
                                                           {"file_sha256", "SHA-256 of the frames"},
                                                           {"atoms", "Atoms"},
                                                           {"frames", "Frames"},
                                                           {"reference", "Source"},
                                                           {"source_sha256", "SHA-256 of the source"},
                                                           {"map", "Potential"},
                                                           {"reference-map", "Map of the source"},
                                                           {"source_map_sha256", "SHA-256 of the source's potential"},
                                                           {"start", "Mappings start from"},
                                                           {"settings", "Options"}};
  StudyJson rows = StudyJson::array();
  std::string version;
  for (const std::string& line : head) {
    const std::size_t begin = line.find_first_not_of(' '), colon = line.find(':');
    if (begin == std::string::npos || colon == std::string::npos) continue;
    const std::string name = line.substr(begin, colon - begin);
    const std::size_t from = line.find_first_not_of(' ', colon + 1);
    std::string text = from == std::string::npos ? "" : line.substr(from);
    if (name == "espdiff") {
      version = text;
      text = "espdiff " + text;
    }
    if (name == "settings") text = text.empty() ? "all have their defaults" : text + "; all others have their defaults";
    const auto found = words.find(name);
    if (!text.empty()) rows.push_back({found == words.end() ? name : found->second, text});
  }
  if (!version.empty()) rows.push_back({"How to cite", citation_of(version)});
  return rows;
}

void add_trajectory(StudyJson& page, PageArrays& arrays, const std::string& prefix) {
  const CsvTable table = read_csv(prefix + ".csv");
  require_rows(table);
  const std::size_t frame = table.require("frame");
  std::vector<std::size_t> places;
  std::vector<std::string> frames;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    places.push_back(row);
    frames.push_back(table.rows[row][frame]);
  }
  page["labels"] = frames;
  page["metrics"] = metric_columns(arrays, table, fields_in_head(table.comments), places, places.size());
  add_remarks(page, table, places, places.size());
  add_summary(page, "frames");
  page["residues"] = residue_rows(arrays, prefix + ".residues.csv", frames);
  page["provenance"] = trajectory_provenance(table.comments);
  page["states"] = std::to_string(frames.size()) + " frames, each compared with one structure";
}

StudyJson head_of(const char* kind, const std::string& prefix, const std::string& title) {
  return {{"kind", kind}, {"title", title.empty() ? std::filesystem::path(prefix).filename().string() : title}};
}

std::vector<std::string> study_scripts() { return {"shared.js", "study.js"}; }

}  // namespace

nlohmann::ordered_json read_study_json(const std::string& path) {
  const FileContent file = read_input(path);
  require_memory_for_json(file.content, path);
  StudyJson json = StudyJson::parse(file.content, nullptr, false);
  if (!json.is_object()) throw FormatError(path, 0, "not a record that espdiff wrote");
  return json;
}

std::string matrix_page(const std::string& prefix, const std::string& title) {
  PageArrays arrays;
  StudyJson page = head_of("matrix", prefix, title);
  try {
    add_matrix(page, arrays, prefix);
  } catch (const StudyJson::exception&) {
    throw FormatError(prefix + ".json", 0, "not a matrix of this version of espdiff; compute it again");
  }
  return assembled_page(page, arrays, "study.html", study_scripts());
}

std::string trajectory_page(const std::string& prefix, const std::string& title) {
  PageArrays arrays;
  StudyJson page = head_of("trajectory", prefix, title);
  add_trajectory(page, arrays, prefix);
  return assembled_page(page, arrays, "study.html", study_scripts());
}

}  // namespace espdiff
