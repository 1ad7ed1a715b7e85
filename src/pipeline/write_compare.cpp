// write_compare.cpp: the mapped surface and the residues as files; all files of a result at once.
#include "pipeline/write_compare.h"

#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/sha256.h"
#include "io/write_csv.h"
#include "io/write_grid.h"
#include "io/write_pqr.h"
#include "io/write_vtp.h"

namespace espdiff {
namespace {

/// Per-vertex arrays that the result implies.
struct DerivedArrays {
  std::vector<float> difference;
  std::vector<std::uint8_t> sign_change;
  std::vector<std::int32_t> residue_number;
};

/// 1 where the signs differ; zero agrees with anything, and so does what lies outside a map.
std::uint8_t sign_changes(float a, float b) { return (a < 0 && b > 0) || (a > 0 && b < 0) ? 1 : 0; }

DerivedArrays derive(const Molecule& source, const CompareResult& result) {
  const MappedSurface& s = result.surface;
  DerivedArrays arrays;
  for (const std::int32_t residue : s.residue) {
    arrays.residue_number.push_back(residue < 0 ? 0 : source.residues.at(static_cast<std::size_t>(residue)).number);
  }
  if (!result.has_potential) return arrays;
  for (std::size_t v = 0; v < s.potential_source.size(); ++v) {
    const float a = s.potential_source[v], b = s.potential_target.at(v);
    arrays.difference.push_back(b - a);
    arrays.sign_change.push_back(sign_changes(a, b));
  }
  return arrays;
}

void write_surface_file(std::ostream& out, const Molecule& source, const CompareResult& result,
                        const Provenance& provenance) {
  const MappedSurface& s = result.surface;
  const DerivedArrays derived = derive(source, result);
  VtpSurface file;
  file.points = VtpArray("Points", s.positions);
  file.triangles = &s.triangles;
  file.point_arrays = {{"source_position", s.source_positions},
                       {"displacement", s.displacement},
                       {"path_length", s.path_length},
                       {"normal", s.normals},
                       {"source_normal", s.source_normals},
                       {"residue_number", derived.residue_number},
                       {"residue_index", s.residue}};
  file.active_normals = "normal";
  file.active_scalars = "displacement";
  if (result.has_potential) {
    file.point_arrays.emplace_back("potential_source", s.potential_source);
    file.point_arrays.emplace_back("potential_target", s.potential_target);
    file.point_arrays.emplace_back("potential_difference", derived.difference);
    file.point_arrays.emplace_back("sign_change", derived.sign_change);
    file.active_scalars = "potential_difference";
    file.texts.emplace_back("potential_unit", to_string(result.unit));
  }
  const std::vector<std::uint8_t> everywhere(s.triangles.size(), 0);
  file.cell_arrays = {{"corrupt", s.corrupt},
                      {"no_counterpart", s.no_counterpart.empty() ? everywhere : s.no_counterpart}};
  file.texts.emplace_back("length_unit", "Angstrom");
  file.texts.emplace_back("written_by", "espdiff " + provenance.version);
  write_vtp(out, file);
}

std::vector<std::string> residue_columns(PotentialUnit unit) {
  const std::string potential = " [" + to_string(unit) + "]";
  return {"chain",
          "residue_number",
          "insertion_code",
          "residue_name",
          "area [A^2]",
          "mean_abs_difference" + potential,
          "mean_signed_difference" + potential,
          "mean_source" + potential,
          "mean_target" + potential,
          "sign_change_area_fraction",
          "mean_displacement [A]",
          "mean_path_length [A]"};
}

void write_residue_file(std::ostream& out, const Molecule& source, const CompareResult& result) {
  write_csv_row(out, residue_columns(result.unit));
  // Without potentials their columns have no values.
  const auto potential = [&](double value) { return result.has_potential ? csv_number(value) : std::string(); };
  for (const ResidueRow& row : result.residues) {
    const Residue& residue = source.residues.at(row.residue);
    const std::string insertion = residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code);
    write_csv_row(
        out, {residue.chain, std::to_string(residue.number), insertion, residue.name, csv_number(row.area_A2),
              potential(row.mean_abs_difference), potential(row.mean_signed_difference), potential(row.mean_source),
              potential(row.mean_target), potential(row.sign_change_area_fraction), csv_number(row.mean_displacement_A),
              csv_number(row.mean_path_length_A)});
  }
}

}  // namespace

InputFile computed_input(const std::string& role, const ComputedMap& map) {
  return {role, "pme of " + map.recipe().charges_from, map.fingerprint(), map.recipe()};
}

CountedSurface counted_surface(const CompareResult& result) {
  if (result.has_potential)
    return {result.metrics.area_A2, result.metrics.mean_displacement_A, result.metrics.mean_path_length_A};
  CountedSurface counted;
  double displacement = 0, path_length = 0;
  for (const ResidueRow& row : result.residues) {
    if (!(row.area_A2 > 0)) continue;
    counted.area_A2 += row.area_A2;
    displacement += row.area_A2 * row.mean_displacement_A;
    path_length += row.area_A2 * row.mean_path_length_A;
  }
  const double area = counted.area_A2 > 0 ? counted.area_A2 : std::numeric_limits<double>::quiet_NaN();
  counted.mean_displacement_A = displacement / area;
  counted.mean_path_length_A = path_length / area;
  return counted;
}

namespace {

/// Files that appear together.
class FileSet {
 public:
  std::ostream& add(const std::string& path) { return files_.emplace_back(path).stream(); }
  std::vector<std::string> commit(AtomicFile* beside = nullptr) {
    std::vector<AtomicFile*> all;
    if (beside != nullptr) all.push_back(beside);
    std::vector<std::string> paths;
    for (AtomicFile& file : files_) {
      all.push_back(&file);
      paths.push_back(file.path());
    }
    commit_all(all);
    return paths;
  }

 private:
  std::deque<AtomicFile> files_;
};

void add_results(FileSet& files, const std::string& output_prefix, const Molecule& source, const Molecule& target,
                 const CompareResult& result, const CompareOptions& options, const Provenance& provenance) {
  files.add(output_prefix + ".json") << compare_json(source, target, result, options, provenance) << '\n';
  write_surface_file(files.add(output_prefix + ".vtp"), source, result, provenance);
  write_residue_file(files.add(output_prefix + ".residues.csv"), source, result);
}

/// Adds a file whose content is the input of this role from now on.
void keep(FileSet& files, Provenance& provenance, const std::string& role, const std::string& path,
          const std::string& content) {
  files.add(path) << content;
  InputFile kept{role, std::filesystem::path(path).filename().string(), sha256_of(content)};
  // All that is in it was compared.
  if (role == "source" || role == "target") kept.read_with = StructureOptions{1, true, true};
  for (InputFile& input : provenance.inputs) {
    if (input.role == role) input = kept;
  }
}

}  // namespace

void write_compare(const std::string& output_prefix, const Molecule& source, const Molecule& target,
                   const CompareResult& result, const CompareOptions& options, const Provenance& provenance,
                   AtomicFile* beside) {
  FileSet files;
  add_results(files, output_prefix, source, target, result, options, provenance);
  files.commit(beside);
}

std::vector<std::string> write_compare_with_inputs(const std::string& output_prefix, const Molecule& source,
                                                   const Molecule& target, const CompareResult& result,
                                                   const CompareOptions& options, Provenance provenance,
                                                   const KeptInputs& kept) {
  FileSet files;
  for (const auto& [role, molecule] : {std::pair("source", &source), std::pair("target", &target)}) {
    std::ostringstream content;
    write_pqr(content, *molecule);
    keep(files, provenance, role, output_prefix + "." + role + ".pqr", content.str());
  }
  for (const auto& [role, map] : {std::pair("source_map", kept.source_map), std::pair("target_map", kept.target_map)}) {
    if (map == nullptr) continue;
    std::ostringstream content;
    write_vti(content, *map);
    keep(files, provenance, role, output_prefix + "." + role + ".vti", content.str());
  }
  add_results(files, output_prefix, source, target, result, options, provenance);
  return files.commit();
}

}  // namespace espdiff
