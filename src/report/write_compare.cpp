// write_compare.cpp: the mapped surface and the residues as files; all files of a result at once.
#include "report/write_compare.h"

#include <deque>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/molecule/surface_parts.h"
#include "certificate/interface_numbers.h"
#include "certificate/region_result.h"
#include "certificate/result.h"
#include "io/files/atomic_file.h"
#include "io/files/sha256.h"
#include "io/files/write_csv.h"
#include "io/grids/write_grid.h"
#include "io/molecules/write_pqr.h"
#include "io/vtk/write_vtp.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "potential/computed_map.h"
#include "report/compare_json.h"
#include "report/field_patches_report.h"
#include "report/records/metrics.h"
#include "report/sections/causes_report.h"
#include "report/sections/interface_report.h"
#include "report/sections/potential_json.h"
#include "report/sections/probed_causes.h"
#include "report/sections/provenance.h"

namespace espdiff {
/// Per-vertex arrays that the result implies.
struct DerivedArrays {
  std::vector<float> difference;
  std::vector<std::uint8_t> sign_change;
  std::vector<std::int32_t> residue_number;
};

namespace {

/// 1 where the signs differ; zero agrees with anything, and so does what lies outside a map.
std::uint8_t sign_changes(float a, float b) { return (a < 0 && b > 0) || (a > 0 && b < 0) ? 1 : 0; }

DerivedArrays derive(const Molecule& source, const CompareResult& result) {
  const MappedSurface& s = result.surface;
  DerivedArrays arrays;
  for (const std::int32_t residue : s.residue) {
    arrays.residue_number.push_back(residue < 0 ? 0 : source.residues.at(static_cast<std::size_t>(residue)).number);
  }
  if (!result.potential.compared) return arrays;
  for (std::size_t v = 0; v < s.potential_source.size(); ++v) {
    const float a = s.potential_source[v], b = s.potential_target.at(v);
    arrays.difference.push_back(b - a);
    arrays.sign_change.push_back(sign_changes(a, b));
  }
  return arrays;
}

}  // namespace

struct SurfaceArrays::Derived {
  DerivedArrays of_vertices;
  std::vector<float> unknown_slip;
  std::vector<std::uint8_t> matched_everywhere;
  std::deque<std::vector<float>> field_differences;
};

SurfaceArrays::SurfaceArrays(const Molecule& source, const CompareResult& result, const std::string& version)
    : derived_(new Derived{derive(source, result), {}, {}, {}}) {
  const MappedSurface& s = result.surface;
  const DerivedArrays& derived = derived_->of_vertices;
  if (s.slip.empty()) derived_->unknown_slip.assign(s.positions.size(), std::numeric_limits<float>::quiet_NaN());
  if (s.unmatched.empty()) derived_->matched_everywhere.assign(s.triangles.size(), 0);
  file.points = VtpArray("Points", s.positions);
  file.triangles = &s.triangles;
  file.point_arrays = {{"source_position", s.source_positions},
                       {"displacement", s.displacement},
                       {"path_length", s.path_length},
                       {"slip", s.slip.empty() ? derived_->unknown_slip : s.slip},
                       {"normal", s.normals},
                       {"source_normal", s.source_normals},
                       {"residue_number", derived.residue_number},
                       {"residue_index", s.residue},
                       {"target_residue_index", s.target_residue}};
  if (!s.turned.empty()) file.point_arrays.emplace_back("turned", s.turned);
  file.active_normals = "normal";
  file.active_scalars = "displacement";
  if (result.potential.compared) {
    file.point_arrays.emplace_back("potential_source", s.potential_source);
    file.point_arrays.emplace_back("potential_target", s.potential_target);
    file.point_arrays.emplace_back("potential_difference", derived.difference);
    file.point_arrays.emplace_back("sign_change", derived.sign_change);
    file.active_scalars = "potential_difference";
    file.texts.emplace_back("potential_unit", potential_unit_text(result));
    const std::string label = potential_label(result);
    if (!label.empty()) file.texts.emplace_back("potential", label);
  }
  for (const FieldResult& field : result.fields) {
    const std::string& name = field.quantity.name;
    std::vector<float>& difference = derived_->field_differences.emplace_back();
    for (std::size_t v = 0; v < field.source.size(); ++v) difference.push_back(field.target[v] - field.source[v]);
    file.point_arrays.emplace_back(name + "_source", field.source);
    file.point_arrays.emplace_back(name + "_target", field.target);
    file.point_arrays.emplace_back(name + "_difference", difference);
    file.texts.emplace_back(name + "_label", field.quantity.label);
    file.texts.emplace_back(name + "_signed", field.quantity.is_signed ? "1" : "0");
    if (!field.quantity.unit.empty()) file.texts.emplace_back(name + "_unit", field.quantity.unit);
  }
  for (const FieldPatches& patches : result.field_patches) {
    file.point_arrays.emplace_back(patches.quantity.name + "_patch_source", patches.source_patch);
    file.point_arrays.emplace_back(patches.quantity.name + "_patch_target", patches.target_patch);
  }
  file.cell_arrays = {{"corrupt", s.corrupt},
                      {"no_counterpart", s.unmatched.empty() ? derived_->matched_everywhere : s.unmatched},
                      {"why", s.why}};
  file.texts.emplace_back("length_unit", "Angstrom");
  file.texts.emplace_back("written_by", "espdiff " + version);
}

SurfaceArrays::~SurfaceArrays() = default;

namespace {

/// "mean_displacement [A]"
std::string column_of(const Metric& metric, const std::string& potential_unit) {
  const std::string unit = unit_of(metric, potential_unit);
  std::string name = metric.name;
  if (metric.unit == MetricUnit::kAngstrom) name.resize(name.size() - std::string("_A").size());
  if (metric.unit == MetricUnit::kSquareAngstrom) name.resize(name.size() - std::string("_A2").size());
  return unit.empty() ? name : name + " [" + unit + "]";
}

void write_residue_file(std::ostream& out, const Molecule& source, const CompareResult& result) {
  std::vector<std::string> columns = {"chain", "residue_number", "insertion_code", "residue_name"};
  const std::vector<Metric> of_residues = residue_metrics(result);
  for (const Metric& metric : of_residues) columns.push_back(column_of(metric, potential_unit_text(result)));
  std::vector<std::set<std::size_t>> parts;
  for (const PartResult& part : result.parts) {
    columns.push_back(part.name == kRegionPart ? part.name : "patch_" + part.name);
    parts.emplace_back();
    for (const ResidueRow& row : part.residues) parts.back().insert(row.residue);
  }
  write_csv_row(out, columns);
  for (const ResidueRow& row : result.residues) {
    const Residue& residue = source.residues.at(row.residue);
    const std::string insertion = residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code);
    std::vector<std::string> cells = {residue.chain, std::to_string(residue.number), insertion, residue.name};
    for (const Metric& metric : of_residues) cells.push_back(csv_number(value_of(metric, result, row)));
    for (const std::set<std::size_t>& part : parts) cells.emplace_back(part.count(row.residue) > 0 ? "1" : "0");
    write_csv_row(out, cells);
  }
}

}  // namespace

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

/// Both molecules and their comparison.
struct Compared {
  const Molecule& source;
  const Molecule& target;
  const CompareResult& result;
};

/// A table that an option asks for.
struct FurtherFile {
  const char* ending;
  bool (*is_wanted)(const CompareOptions& options);
  void (*write)(std::ostream& out, const Compared& of);
};

template <void (*Write)(std::ostream&, const Causes&, const std::string&)>
void write_of_causes(std::ostream& out, const Compared& of) {
  if (of.result.causes != nullptr) Write(out, *of.result.causes, potential_unit_text(of.result));
}

constexpr FurtherFile kFurtherFiles[] = {
    {".field_patches.csv", [](const CompareOptions& o) { return !o.patches_of.empty(); },
     [](std::ostream& out, const Compared& of) {
       write_field_patches(out, of.source, of.target, of.result.field_patches);
     }},
    {".interface.csv", [](const CompareOptions& o) { return !o.interface.empty(); },
     [](std::ostream& out, const Compared& of) {
       const InterfaceComparison& interface = *of.result.interface;
       write_interface_rows(out, interface.first, interface.second, 2, interface.rows);
     }},
    {".causes.csv", [](const CompareOptions& o) { return !o.causes.empty(); }, write_of_causes<write_causes>},
    {".scan.csv", [](const CompareOptions& o) { return o.scan; }, write_of_causes<write_scan>},
    {".side-chains.csv", [](const CompareOptions& o) { return o.side_chains > 0; },
     write_of_causes<write_side_chains>}};

void add_results(FileSet& files, const std::string& output_prefix, const Molecule& source, const Molecule& target,
                 const CompareResult& result, const CompareOptions& options, const Provenance& provenance) {
  // A path need not be UTF-8, JSON must be.
  files.add(output_prefix + ".json") << compare_json(source, target, result, options, provenance)
                                            .dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                                     << '\n';
  write_vtp(files.add(output_prefix + ".vtp"), SurfaceArrays(source, result, provenance.version).file);
  write_residue_file(files.add(output_prefix + ".residues.csv"), source, result);
  for (const FurtherFile& file : kFurtherFiles) {
    if (file.is_wanted(options)) file.write(files.add(output_prefix + file.ending), {source, target, result});
  }
}

/// Adds a file whose content is the input of this role from now on.
void keep(FileSet& files, Provenance& provenance, const std::string& role, const std::string& path,
          const std::string& content) {
  files.add(path) << content;
  InputFile kept{role, std::filesystem::path(path).filename().string(), sha256_of(content), {}, {}};
  // All that is in it was compared.
  if (role == "source" || role == "target") kept.read_with = StructureOptions{1, true, true};
  for (InputFile& input : provenance.inputs) {
    if (input.role == role) input = kept;
  }
}

/// What the input of a role was before its file was kept: by the role of the same name and "_file".
void remember_original(Provenance& provenance, const std::optional<InputFile>& original) {
  if (!original) return;
  provenance.inputs.push_back(*original);
  provenance.inputs.back().role += "_file";
}

std::optional<InputFile> input_of(const Provenance& provenance, const std::string& role) {
  for (const InputFile& input : provenance.inputs) {
    if (input.role == role) return input;
  }
  return {};
}

}  // namespace

std::vector<std::string> further_endings(const CompareOptions& options) {
  std::vector<std::string> endings;
  for (const FurtherFile& file : kFurtherFiles) {
    if (file.is_wanted(options)) endings.emplace_back(file.ending);
  }
  return endings;
}

void write_compare(const std::string& output_prefix, const Molecule& source, const Molecule& target,
                   const CompareResult& result, const CompareOptions& options, Provenance provenance,
                   const std::vector<KeptFile>& kept, AtomicFile* beside) {
  FileSet files;
  for (const KeptFile& file : kept) {
    const std::optional<InputFile> original = input_of(provenance, file.role);
    keep(files, provenance, file.role, output_prefix + file.ending, file.content);
    remember_original(provenance, original);
  }
  add_results(files, output_prefix, source, target, result, options, provenance);
  files.commit(beside);
}

std::vector<std::string> kept_input_endings(const KeptInputs& kept) {
  std::vector<std::string> endings = {".source.pqr", ".target.pqr"};
  if (kept.source_map != nullptr) endings.emplace_back(".source_map.vti");
  if (kept.target_map != nullptr) endings.emplace_back(".target_map.vti");
  return endings;
}

std::vector<std::string> write_compare_with_inputs(const std::string& output_prefix, const Molecule& source,
                                                   const Molecule& target, const CompareResult& result,
                                                   const CompareOptions& options, Provenance provenance,
                                                   const KeptInputs& kept) {
  FileSet files;
  for (const auto& [role, molecule] : {std::pair("source", &source), std::pair("target", &target)}) {
    std::ostringstream content;
    write_pqr(content, *molecule);
    const std::optional<InputFile> original = input_of(provenance, role);
    keep(files, provenance, role, output_prefix + "." + role + ".pqr", content.str());
    remember_original(provenance, original);
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
