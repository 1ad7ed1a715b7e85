// pair_files.cpp: reads the files of a comparison again, and what several formats take from them.
#include "report/records/pair_files.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/molecule/structure_options.h"
#include "base/text/citation.h"
#include "base/text/formats.h"
#include "io/files/read_input.h"
#include "io/text/json_values.h"
#include "report/records/metrics.h"

namespace espdiff {
namespace {

using RecordJson = nlohmann::ordered_json;

constexpr const char* kCompareAgain = "; compare again with this version of espdiff";

struct UsualQuantity {
  const char *array, *label;
  bool is_potential, has_length, is_signed;
};

constexpr UsualQuantity kUsualQuantities[] = {
    {"potential_difference", "Difference", true, false, true},
    {"potential_source", "Potential of the source", true, false, true},
    {"potential_target", "Potential of the target", true, false, true},
    {"sign_change", "Change of sign", false, false, false},
    {"slip", "Slip of the mapping", false, true, false},
    {"displacement", "Displacement", false, true, false},
    {"path_length", "Length of the path", false, true, false},
    {"turned", "Turned (1: side chain, 2: residue, 3: side chain, 8 A and more)", false, false, false},
};

/// Whether the record has what its readers take for granted.
bool is_whole(const RecordJson& record) {
  if (!record.is_object() || !record.contains("certificate") || !record.contains("superposition")) return false;
  const RecordJson &certificate = record.at("certificate"), &superposition = record.at("superposition");
  const auto has_numbers = [&](const char* name, std::size_t n) {
    if (!superposition.contains(name)) return false;
    const RecordJson& list = superposition.at(name);
    return list.is_array() && list.size() == n &&
           std::all_of(list.begin(), list.end(), [](const RecordJson& value) { return value.is_number(); });
  };
  const auto is_list = [](const RecordJson& json, const char* name) {
    return !json.contains(name) || json.at(name).is_array();
  };
  return certificate.is_object() && certificate.contains("trustworthy") && certificate.at("trustworthy").is_boolean() &&
         superposition.is_object() && has_numbers("rotation_row_major", 9) && has_numbers("translation_A", 3) &&
         is_list(record, "inputs") && is_list(record, "warnings") && is_list(certificate, "reasons");
}

const VtpNumbers& required_array(const PairFiles& files, const char* name, int n_components) {
  const VtpNumbers* const array = find_array(files.surface.point_arrays, name);
  if (array == nullptr || array->n_components != n_components)
    throw FormatError(files.prefix + ".vtp", 0, "has no point array '" + std::string(name) + "'" + kCompareAgain);
  return *array;
}

std::string text_of(const RecordJson& json, const std::string& name) {
  return json.is_object() && json.contains(name) && json.at(name).is_string() ? json.at(name).get<std::string>() : "";
}

std::vector<std::string> texts_of(const RecordJson& json, const std::string& name) {
  std::vector<std::string> texts;
  for (const RecordJson& item : json.value(name, RecordJson::array())) {
    const std::string text = item.is_string() ? item.get<std::string>() : text_of(item, "text");
    if (!text.empty()) texts.push_back(text);
  }
  return texts;
}

struct FieldWords {
  std::string label, unit;
};

/// What the record says of the field whose values at the source, the target, or their difference an array has; empty
/// without one.
FieldWords field_words(const RecordJson& record, const std::string& array) {
  const std::size_t end = array.rfind('_');
  const RecordJson fields = record.value("fields", RecordJson::object());
  if (end == std::string::npos || !fields.is_object() || !fields.contains(array.substr(0, end))) return {};
  const RecordJson& field = fields.at(array.substr(0, end));
  const std::string label = text_of(field, "label");
  if (label.empty()) return {};
  return {label + ", " + array.substr(end + 1), text_of(field, "unit")};
}

/// The metric of a column such as "mean_slip", whose name may lack its unit.
const Metric* metric_of_residue_column(const std::string& name) {
  for (const char* ending : {"", "_A", "_A2"}) {
    if (const Metric* metric = find_metric_or_null(name + ending)) return metric;
  }
  return nullptr;
}

}  // namespace

std::string options_of(const nlohmann::ordered_json& record) {
  std::string options;
  const RecordJson settings = record.value("options", RecordJson::object());  // items() keeps a reference
  for (const auto& [name, value] : settings.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (!text.empty()) options += (options.empty() ? "" : ", ") + name + ' ' + text;
  }
  return options;
}

void require_format_version(const nlohmann::ordered_json& record, const std::string& path) {
  const RecordJson version = record.value("format_version", RecordJson(kFormatVersion));
  if (version == kFormatVersion) return;
  const std::string program = text_of(record, "version");
  throw FormatError(path, 0,
                    "version " + version.dump() + " of the format" +
                        (program.empty() ? "" : ", written by espdiff " + program) + "; this espdiff reads version " +
                        std::to_string(kFormatVersion) + ": use that espdiff, or compute the result again");
}

nlohmann::ordered_json read_comparison_record(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw IoError(path, "cannot be read: No such file or directory; give the prefix OUT of a result, or its OUT.json");
  const FileContent file = read_input(path);
  require_memory_for_json(file.content, path);
  RecordJson record = RecordJson::parse(file.content, nullptr, false);
  if (record.is_discarded() || !is_whole(record))
    throw FormatError(path, 0, "not a record that `espdiff compare` wrote; compare again");
  require_format_version(record, path);
  return record;
}

PairFiles read_pair_files(const std::string& prefix) {
  PairFiles files;
  files.prefix = prefix;
  files.record = read_comparison_record(prefix + ".json");
  files.unit = text_of(files.record, "potential_unit");
  files.surface = read_vtp(prefix + ".vtp");
  const RecordJson n_vertices = files.record.value("n_vertices", RecordJson());
  if (!n_vertices.is_number_unsigned() || n_vertices.get<std::size_t>() != files.surface.positions.size())
    throw FormatError(prefix + ".vtp", 0,
                      std::to_string(files.surface.positions.size()) + " vertices, and not those of " + prefix +
                          ".json; compare again");
  if (files.surface.triangles.empty())
    throw FormatError(prefix + ".vtp", 0, "the surface has no triangles; compare again");
  for (const UsualQuantity& usual : kUsualQuantities)
    if (usual.is_potential && !files.unit.empty()) required_array(files, usual.array, 1);
  files.residues = read_csv(prefix + ".residues.csv");
  for (const char* column : {"chain", "residue_number", "insertion_code", "residue_name"})
    files.residues.require(column);
  return files;
}

std::vector<SurfaceQuantity> surface_quantities(const PairFiles& files) {
  std::vector<SurfaceQuantity> quantities;
  for (const UsualQuantity& usual : kUsualQuantities) {
    const VtpNumbers* const array = find_array(files.surface.point_arrays, usual.array);
    if (array == nullptr || array->n_components != 1) continue;
    quantities.push_back({array, usual.label,
                          usual.is_potential ? files.unit
                          : usual.has_length ? "A"
                                             : "",
                          usual.is_signed});
  }
  for (const VtpNumbers& array : files.surface.point_arrays) {
    const bool is_usual = std::any_of(std::begin(kUsualQuantities), std::end(kUsualQuantities),
                                      [&](const UsualQuantity& usual) { return array.name == usual.array; });
    if (is_usual || array.n_components != 1 || array.name.rfind("residue_", 0) == 0) continue;
    if (array.name == "target_residue_index") continue;  // a number of no size
    const bool has_negative =
        std::any_of(array.values.begin(), array.values.end(), [](double value) { return value < 0; });
    const FieldWords field = field_words(files.record, array.name);
    quantities.push_back({&array, field.label.empty() ? array.name : field.label, field.unit, has_negative});
  }
  return quantities;
}

std::vector<std::int32_t> residues_of_vertices(const PairFiles& files) {
  std::vector<std::int32_t> residues;
  const std::size_t n_rows = files.residues.rows.size();
  for (const double index : required_array(files, "residue_index", 1).values) {
    if (index >= static_cast<double>(n_rows))
      throw FormatError(files.residues.path, 0,
                        "there is no row " + std::to_string(n_rows + 1) + ", and " + files.prefix +
                            ".vtp has points of its residue or of a later one; compare again");
    residues.push_back(index >= 0 ? static_cast<std::int32_t>(index) : -1);
  }
  return residues;
}

std::vector<Vec3d> superposed_source(const PairFiles& files) {
  const VtpNumbers& positions = required_array(files, "source_position", 3);
  const RecordJson& superposition = files.record.at("superposition");
  RigidTransform to_target;
  for (std::size_t i = 0; i < 9; ++i) to_target.rotation[i] = superposition.at("rotation_row_major").at(i);
  const RecordJson& shift = superposition.at("translation_A");
  to_target.translation = {shift.at(0), shift.at(1), shift.at(2)};
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i + 2 < positions.values.size(); i += 3)
    out.push_back(to_target.apply({positions.values[i], positions.values[i + 1], positions.values[i + 2]}));
  return out;
}

CountedTriangles counted_triangles(const VtpContent& surface) {
  CountedTriangles triangles;
  const VtpNumbers* const why = find_array(surface.cell_arrays, "why");
  const VtpNumbers* const corrupt = find_array(surface.cell_arrays, "corrupt");
  const VtpNumbers* const unmatched = find_array(surface.cell_arrays, "no_counterpart");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const bool is_counted = (why == nullptr || why->values[t] == 0) &&
                            (corrupt == nullptr || corrupt->values[t] == 0) &&
                            (unmatched == nullptr || unmatched->values[t] == 0);
    (is_counted ? triangles.counted : triangles.rest).push_back(surface.triangles[t]);
  }
  return triangles;
}

std::vector<ResidueColumn> residue_columns(const CsvTable& residues) {
  std::vector<ResidueColumn> columns;
  for (std::size_t c = residues.require("residue_name") + 1; c < residues.columns.size(); ++c) {
    const std::string& text = residues.columns[c];
    const std::size_t bracket = text.find(" [");
    const std::string name = text.substr(0, bracket);
    const Metric* const metric = metric_of_residue_column(name);
    columns.push_back({c, name, bracket == std::string::npos ? "" : text.substr(bracket + 2, text.size() - bracket - 3),
                       metric != nullptr ? metric->label : name});
  }
  return columns;
}

std::string name_of_input(const PairFiles& files, const std::string& role) {
  std::string name = role;
  for (const RecordJson& input : files.record.value("inputs", RecordJson::array())) {
    const std::string its_role = text_of(input, "role");
    // A state that was prepared is kept beside the result; the user's file stands behind it.
    if (its_role != role && its_role != role + "_file") continue;
    name = with_model(std::filesystem::path(text_of(input, "path")).filename().string(), Record(input).count("/model"));
  }
  return name;
}

std::string title_of(const PairFiles& files) {
  return name_of_input(files, "target") + " against " + name_of_input(files, "source");
}

Verdict verdict_of(const PairFiles& files) {
  const RecordJson& certificate = files.record.at("certificate");
  Verdict verdict;
  verdict.trustworthy = certificate.at("trustworthy").get<bool>();
  verdict.text = text_of(certificate, "verdict");
  if (verdict.text.empty()) verdict.text = verdict.trustworthy ? "TRUSTWORTHY" : "NOT TRUSTWORTHY";
  verdict.reasons = texts_of(certificate, "reasons");
  verdict.parts = texts_of(certificate, "untrusted_parts");
  verdict.warnings = texts_of(files.record, "warnings");
  return verdict;
}

std::vector<std::pair<std::string, std::string>> provenance_of(const PairFiles& files) {
  const RecordJson& record = files.record;
  std::vector<std::pair<std::string, std::string>> rows;
  rows.emplace_back("Command", text_of(record, "command_line"));
  const std::string version = text_of(record, "version");
  rows.emplace_back("Program", "espdiff " + version + ", on " + text_of(record, "device") + " (" +
                                   text_of(record, "device_description") + ")");
  for (const RecordJson& input : record.value("inputs", RecordJson::array())) {
    std::string text = text_of(input, "path");
    if (const std::string sha256 = text_of(input, "sha256"); !sha256.empty()) text += ", SHA-256 " + sha256;
    rows.emplace_back("Input: " + text_of(input, "role"), text);
  }
  rows.emplace_back("Options", options_of(record));
  rows.emplace_back("How to cite", citation_of(version));
  return rows;
}

}  // namespace espdiff
