// array_lines.cpp: arrays of OUT.vtp and columns of OUT.residues.csv that follow from others, or from the atoms.
#include "verify/array_lines.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "base/text/formats.h"
#include "verify/mapped_file.h"
#include "verify/target_surface.h"

namespace espdiff {
namespace {

/// Of unit normals, which the engine has in single precision.
constexpr double kNormalTolerance = 0.02;
/// Where the density is flat, its gradient has no direction.
constexpr double kNormalShare = 5e-3;

/// Share of the matched area whose normals are not those of the density.
double turned_share(const MappedFile& file, const std::vector<Vec3d>& normals, const std::vector<Vec3d>& positions,
                    const GaussianAtoms& atoms) {
  const std::vector<double> weight = file.weights(file.is_valid);
  double all = 0, turned = 0;
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (weight[v] <= 0) continue;
    Vec3d gradient;
    atoms.at(positions[v], gradient);
    all += weight[v];
    const double deviation = norm(normals[v] + (1 / norm(gradient)) * gradient);
    turned += deviation <= kNormalTolerance ? 0 : weight[v];  // NaN counts
  }
  return all > 0 ? turned / all : 0;
}

double number_or_nan(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? std::nan("") : value;
}

}  // namespace

void add_array_lines(const MappedFile& file, Lines& lines) {
  for (const std::string& name : file.array_names) lines.has("OUT.vtp/" + name);
  // Positions, what is matched and the mapping's lengths carry most other lines.
  for (const char* name : {"source_position", "displacement", "path_length", "slip", "residue_index", "corrupt",
                           "no_counterpart", "potential_source", "potential_target"})
    lines.cover(std::string("OUT.vtp/") + name);
  lines.add("n_vertices", static_cast<double>(file.positions.size()), 0);
  lines.add("n_triangles", static_cast<double>(file.triangles.size()), 0);
  if (file.potential_source.empty()) return;
  double largest = 0, scale = 1e-30, wrong = 0;
  for (std::size_t v = 0; v < file.positions.size(); ++v) {
    const double a = file.potential_source[v], b = file.potential_target[v], d = file.potential_difference[v];
    wrong += (file.sign_change[v] != 0) == (a * b < 0) ? 0 : 1;
    if (std::isfinite(b - a) != std::isfinite(d)) largest = std::numeric_limits<double>::infinity();
    if (!std::isfinite(d) || !std::isfinite(b - a)) continue;
    largest = std::max(largest, std::fabs(d - (b - a)));
    scale = std::max({scale, std::fabs(a), std::fabs(b)});
  }
  lines.add_deviation("OUT.vtp/potential_difference, largest deviation", largest, 1e-6 * scale);
  lines.add_deviation("OUT.vtp/sign_change, vertices that differ", wrong, 0);
  lines.cover("OUT.vtp/potential_difference");
  lines.cover("OUT.vtp/sign_change");
}

void add_text_lines(const MappedFile& file, const ResultRecord& record, Lines& lines) {
  const auto text = [&](const char* name) {
    const auto found =
        std::find_if(file.texts.begin(), file.texts.end(), [&](const auto& entry) { return entry.first == name; });
    return found == file.texts.end() ? std::string() : found->second;
  };
  lines.add_deviation("OUT.vtp/length_unit, other than Angstrom", text("length_unit") == "Angstrom" ? 0 : 1, 0);
  lines.cover("OUT.vtp/length_unit");
  lines.cover("OUT.vtp/written_by");
  lines.cover("version");
  lines.cover("format");
  lines.cover("format_version");
  lines.add_deviation(
      "format, other than this version's",
      record.text("format") == kComparisonFormat && record.number("format_version") == kFormatVersion ? 0 : 1, 0);
  lines.add_deviation("version, against OUT.vtp", text("written_by") == "espdiff " + record.text("version") ? 0 : 1, 0);
  lines.cover("OUT.vtp/potential_unit");
  lines.add_text("potential_unit", text("potential_unit"), "OUT.vtp");
  if (record.size("potential") == 0) return;  // of given maps: its kind follows from their check
  lines.cover("OUT.vtp/potential");
  lines.add_text("potential/label", text("potential"), "OUT.vtp");
}

void add_normal_lines(const MappedFile& file, const GaussianAtoms& source, const GaussianAtoms& target, Lines& lines) {
  lines.add_deviation("OUT.vtp/normal, share of the area that differs",
                      turned_share(file, file.normals, file.positions, target), kNormalShare);
  lines.add_deviation("OUT.vtp/source_normal, share of the area that differs",
                      turned_share(file, file.source_normals, file.source_positions, source), kNormalShare);
  lines.cover("OUT.vtp/normal");
  lines.cover("OUT.vtp/source_normal");
}

void add_residue_name_lines(const MappedFile& file, const CsvTable& table, const std::vector<Residue>& residues,
                            Lines& lines) {
  const std::size_t columns[] = {table.require("chain"), table.require("residue_number"),
                                 table.require("insertion_code"), table.require("residue_name")};
  double wrong = table.rows.size() == residues.size() ? 0 : 1, other = 0;
  for (std::size_t r = 0; r < std::min(table.rows.size(), residues.size()); ++r) {
    const auto& row = table.rows[r];
    const Residue& residue = residues[r];
    const std::string insertion = residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code);
    const bool same = row[columns[0]] == residue.chain && number_or_nan(row[columns[1]]) == residue.number &&
                      row[columns[2]] == insertion && row[columns[3]] == residue.name;
    wrong += same ? 0 : 1;
  }
  for (std::size_t v = 0; v < file.residue.size(); ++v) {
    const double r = file.residue[v];
    const bool known = r >= 0 && r < static_cast<double>(residues.size());
    other += file.residue_number[v] == (known ? residues[static_cast<std::size_t>(r)].number : 0) ? 0 : 1;
  }
  lines.add_deviation("OUT.residues.csv, residues named otherwise than in the source", wrong, 0);
  lines.add_deviation("OUT.vtp/residue_number, vertices that differ", other, 0);
  for (const char* name : {"chain", "residue_number", "insertion_code", "residue_name"})
    lines.cover(std::string("OUT.residues.csv/") + name);
  lines.cover("OUT.vtp/residue_number");
}

}  // namespace espdiff
