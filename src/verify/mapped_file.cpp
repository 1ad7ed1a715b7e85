// mapped_file.cpp: reads OUT.vtp; areas and weights in double precision.
#include "verify/mapped_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/error.h"

namespace espdiff {
namespace {

std::vector<double> array(const std::string& path, const std::vector<VtpNumbers>& arrays, const std::string& name,
                          int n_components) {
  const VtpNumbers* const found = find_array(arrays, name);
  if (found == nullptr)
    throw InputError(path + ": has no array \"" + name + "\", which a comparison writes; compare again");
  if (found->n_components != n_components)
    throw InputError(path + ": the array \"" + name + "\" has " + std::to_string(found->n_components) +
                     " components, expected " + std::to_string(n_components) + "; compare again");
  return found->values;
}

/// Residues are indices, or negative for none.
void check_residues(const std::string& path, const std::vector<double>& residue, const char* name) {
  for (const double r : residue) {
    if (r == std::floor(r) && r >= -1 && r < std::numeric_limits<std::int32_t>::max()) continue;
    throw InputError(path + ": the array \"" + name + "\" has entries that are not indices; compare again");
  }
}

double area_of_corners(const std::vector<Vec3d>& p, const Triangle& t) {
  return 0.5 * norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
}

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  VtpContent content = read_vtp(path);
  const auto of_points = [&](const char* name) { return array(path, content.point_arrays, name, 1); };
  const auto vectors_of = [&](const char* name) {
    const std::vector<double> flat = array(path, content.point_arrays, name, 3);
    std::vector<Vec3d> vectors;
    for (std::size_t k = 0; k + 2 < flat.size(); k += 3) vectors.push_back({flat[k], flat[k + 1], flat[k + 2]});
    return vectors;
  };
  source_positions = vectors_of("source_position");
  normals = vectors_of("normal");
  source_normals = vectors_of("source_normal");
  residue_number = of_points("residue_number");
  displacement = of_points("displacement");
  path_length = of_points("path_length");
  slip = of_points("slip");
  residue = of_points("residue_index");
  target_residue = of_points("target_residue_index");
  turned = of_points("turned");
  check_residues(path, residue, "residue_index");
  check_residues(path, target_residue, "target_residue_index");
  if (find_array(content.point_arrays, "potential_source") != nullptr) {
    potential_source = of_points("potential_source");
    potential_target = of_points("potential_target");
    potential_difference = of_points("potential_difference");
    sign_change = of_points("sign_change");
  }
  for (const auto* arrays : {&content.point_arrays, &content.cell_arrays}) {
    for (const VtpNumbers& entry : *arrays) array_names.push_back(entry.name);
  }
  for (const auto& entry : content.texts) array_names.push_back(entry.first);
  texts = content.texts;
  for (const double flag : array(path, content.cell_arrays, "no_counterpart", 1)) is_matched.push_back(flag == 0);
  const std::vector<double> corrupt = array(path, content.cell_arrays, "corrupt", 1);
  for (std::size_t t = 0; t < corrupt.size(); ++t) is_valid.push_back(is_matched[t] && corrupt[t] == 0);
  why = array(path, content.cell_arrays, "why", 1);
  for (const double reason : why) {
    if (!(reason >= 0 && reason < static_cast<double>(kNumberOfReasons)))
      throw InputError(path + ": the array \"why\" has entries that are no reasons; compare again");
    is_trusted.push_back(reason == 0);
  }
  positions = std::move(content.positions);
  triangles = std::move(content.triangles);
  if (std::find(is_matched.begin(), is_matched.end(), true) == is_matched.end())
    throw InputError(path + ": has no matched triangle, so that there is nothing to verify");
}

double MappedFile::area(std::size_t t) const { return area_of_corners(positions, triangles[t]); }
double MappedFile::source_area(std::size_t t) const { return area_of_corners(source_positions, triangles[t]); }

std::vector<Triangle> MappedFile::matched() const {
  std::vector<Triangle> all;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_matched[t]) all.push_back(triangles[t]);
  }
  return all;
}

std::vector<double> MappedFile::weights(const std::vector<bool>& counts) const {
  std::vector<double> weight(positions.size(), 0.0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!counts[t]) continue;
    for (const std::uint32_t c : triangles[t]) weight[c] += area(t) / 3;
  }
  return weight;
}

std::vector<bool> MappedFile::with_potentials(std::vector<bool> counts) const {
  for (std::size_t t = 0; t < triangles.size() && !potential_source.empty(); ++t) {
    for (const std::uint32_t c : triangles[t])
      counts[t] = counts[t] && std::isfinite(potential_source[c]) && std::isfinite(potential_target[c]);
  }
  return counts;
}

int column(const CsvTable& table, const std::string& name) {
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k] == name || table.columns[k].rfind(name + " [", 0) == 0) return static_cast<int>(k);
  }
  return -1;
}

double weighted_quantile(std::vector<std::pair<double, double>> weighted, double share) {
  std::sort(weighted.begin(), weighted.end());
  double all = 0, below = 0;
  for (const auto& entry : weighted) all += entry.second;
  for (const auto& [value, weight] : weighted) {
    if ((below += weight) >= share * all) return value;
  }
  return weighted.empty() ? std::numeric_limits<double>::quiet_NaN() : weighted.back().first;
}

}  // namespace espdiff
