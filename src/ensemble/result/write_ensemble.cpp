// write_ensemble.cpp: the surface and the tables of an ensemble's statistics.
#include "ensemble/result/write_ensemble.h"

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_json.h"
#include "ensemble/result/ensemble_result.h"
#include "io/files/atomic_file.h"
#include "io/files/write_csv.h"
#include "io/vtk/write_vtp.h"

namespace espdiff {
namespace {

std::vector<std::int32_t> patch_numbers(const EnsembleResult& result) {
  std::vector<std::int32_t> numbers(result.tested.size(), 0);
  for (std::size_t k = 0; k < result.patches.size(); ++k) {
    for (const std::uint32_t v : result.patches[k].patch.vertices) numbers[v] = static_cast<std::int32_t>(k + 1);
  }
  return numbers;
}

void write_surface(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result) {
  const TemplateSurface& surface = file.surface();
  // Arrays refer to values that must outlast the writing.
  std::vector<std::unique_ptr<std::vector<float>>> kept;
  VtpSurface vtp;
  vtp.points = VtpArray("points", surface.positions);
  vtp.triangles = &surface.triangles;
  vtp.point_arrays = {{"normal", surface.normals}, {"residue_index", surface.residue}};
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    kept.push_back(std::make_unique<std::vector<float>>(where_tested(values, result.tested)));
    vtp.point_arrays.emplace_back(name, *kept.back());
  };
  const std::vector<std::string> sides = {"source", "target"};
  const auto& field = file.plan().field;
  const std::string quantity = field ? field->quantity.name : "potential";
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    add(quantity + "_" + sides[g], result.groups[g].mean);
    add("deviation_" + sides[g], result.groups[g].deviation);
    add("effective_samples_" + sides[g], result.groups[g].effective);
    kept.push_back(
        std::make_unique<std::vector<float>>(result.groups[g].trusted.begin(), result.groups[g].trusted.end()));
    vtp.point_arrays.emplace_back("trusted_" + sides[g], *kept.back());
    vtp.texts.emplace_back(sides[g] + "_group", result.groups[g].name);
  }
  const std::vector<std::int32_t> patch = patch_numbers(result);
  if (result.compares) {
    const PlaceTests& t = result.test.vertices;
    add(quantity + "_difference", t.difference);
    add("difference_low", t.low);
    add("difference_high", t.high);
    add("standard_error", t.error);
    add("t", t.t);
    add("p", t.p);
    add("tfce", result.test.tfce);
    add("p_max_t", result.test.p_max_t);
    add("p_tfce", result.test.p_tfce);
    add("p_family_wise", result.family_wise());
    vtp.point_arrays.emplace_back("patch", patch);
    vtp.texts.emplace_back("alpha", csv_number(result.options.alpha));
    vtp.active_scalars = quantity + "_difference";
  } else {
    vtp.active_scalars = quantity + "_source";
  }
  if (result.regression) {
    const SurfaceRegression& r = result.regression->surface;
    add("regression_correlation", r.correlation);
    add("regression_slope", r.slope);
    add("regression_t", r.t);
    add("regression_p_max_t", r.p_max_t);
    add("regression_p_tfce", r.p_tfce);
  }
  for (std::size_t k = 0; result.states && k < result.states->components.size(); ++k) {
    const std::vector<double>& mode = result.states->components[k].mode;
    kept.push_back(std::make_unique<std::vector<float>>(mode.begin(), mode.end()));
    vtp.point_arrays.emplace_back("component_" + std::to_string(k + 1), *kept.back());
  }
  std::vector<std::uint8_t> untested;
  for (const Triangle& corners : surface.triangles) {
    bool any = false;
    for (const std::uint32_t v : corners) any = any || result.tested[v] == 0;
    untested.push_back(any ? 1 : 0);
  }
  vtp.cell_arrays = {{"untested", untested}};
  if (field) {
    vtp.texts.emplace_back(quantity + "_label", field->quantity.label);
    vtp.texts.emplace_back(quantity + "_signed", field->quantity.is_signed ? "1" : "0");
    if (!field->quantity.unit.empty()) vtp.texts.emplace_back(quantity + "_unit", field->quantity.unit);
  } else {
    vtp.texts.emplace_back("potential_unit", file.plan().potential_unit);
  }
  vtp.texts.emplace_back("written_by", std::string("espdiff ") + kVersion + " ensemble");
  vtp.active_normals = "normal";
  write_vtp(out, vtp);
}

void write_residues(std::ostream& out, const EnsembleResult& result) {
  std::vector<std::string> names = {"residue", "area_A2"};
  for (const GroupColumns& group : result.groups) names.push_back("mean_" + group.name);
  if (result.compares)
    names.insert(names.end(), {"difference", "low", "high", "t", "p", "p_false_discovery", "significant_area_A2"});
  write_csv_row(out, names);
  for (std::size_t i = 0; i < result.residues.size(); ++i) {
    const EnsembleResidue& r = result.residues[i];
    std::vector<std::string> row = {r.label, csv_number(r.area_A2)};
    for (const double mean : r.means) row.push_back(csv_number(mean));
    if (result.compares) {
      const PlaceTests& t = result.residue_tests;
      for (const double value :
           {t.difference[i], t.low[i], t.high[i], t.t[i], t.p[i], r.adjusted_p, r.significant_area_A2})
        row.push_back(csv_number(value));
    }
    write_csv_row(out, row);
  }
}

/// "LYS 8 of chain A 62 %; ..."
std::string residues_in_words(const EnsemblePatch& patch) {
  std::string text;
  for (const auto& [residue, share] : patch.residues)
    text += (text.empty() ? "" : "; ") + residue + " " + csv_number(100 * share, 3) + " %";
  return text;
}

void write_patches(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result) {
  write_csv_row(out, {"patch", "area_A2", "difference", "low", "high", "smallest_p", "peak_x_A", "peak_y_A", "peak_z_A",
                      "peak_difference", "residues"});
  for (std::size_t k = 0; k < result.patches.size(); ++k) {
    const EnsemblePatch& patch = result.patches[k];
    const PlaceTests& t = result.patch_tests;
    const Vec3d& peak = file.surface().positions[patch.patch.peak];
    write_csv_row(out, {std::to_string(k + 1), csv_number(patch.patch.area), csv_number(t.difference[k]),
                        csv_number(t.low[k]), csv_number(t.high[k]), csv_number(patch.smallest_p), csv_number(peak.x),
                        csv_number(peak.y), csv_number(peak.z),
                        csv_number(result.test.vertices.difference[patch.patch.peak]), residues_in_words(patch)});
  }
}

/// The mean of each patch in each frame.
void write_series(std::ostream& out, const EnsembleFile& file, const EnsembleResult& result) {
  std::vector<std::string> names = {"group", "replicate", "frame"};
  for (std::size_t k = 0; k < result.patches.size(); ++k) names.push_back("patch_" + std::to_string(k + 1));
  write_csv_row(out, names);
  std::vector<float> values(file.n_vertices());
  for (std::size_t f = 0; f < file.plan().n_frames(); ++f) {
    const auto [replicate, number] = file.plan().place_of(f);
    const EnsembleReplicate& r = file.plan().replicates[replicate];
    std::vector<std::string> row = {r.group, r.name, std::to_string(number)};
    file.read_values(f, 0, values.size(), values.data());
    for (const EnsemblePatch& patch : result.patches) {
      double sum = 0, area = 0;
      for (const std::uint32_t v : patch.patch.vertices) {
        if (!std::isfinite(values[v])) continue;
        sum += result.graph.area[v] * static_cast<double>(values[v]);
        area += result.graph.area[v];
      }
      row.push_back(csv_number(area > 0 ? sum / area : std::numeric_limits<double>::quiet_NaN()));
    }
    write_csv_row(out, row);
  }
}

/// Each replicate's value, and what the others predict.
void write_regression(std::ostream& out, const EnsembleFile& file, const EnsembleRegression& regression) {
  write_csv_row(out, {"group", "replicate", regression.column.name, "predicted"});
  for (std::size_t r = 0; r < regression.column.values.size(); ++r) {
    const EnsembleReplicate& replicate = file.plan().replicates[r];
    write_csv_row(out, {replicate.group, replicate.name, csv_number(regression.column.values[r]),
                        csv_number(regression.surface.predicted[r])});
  }
}

}  // namespace

std::vector<std::string> ensemble_outputs(const std::string& prefix, const EnsembleOutputs& parts) {
  std::vector<std::string> paths = {prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"};
  if (parts.compares) paths.insert(paths.end(), {prefix + ".patches.csv", prefix + ".patch_series.csv"});
  if (parts.has_states) paths.insert(paths.end(), {prefix + ".states.csv", prefix + ".components.csv"});
  if (parts.regresses) paths.push_back(prefix + ".regression.csv");
  if (parts.has_causes) paths.push_back(prefix + ".causes.csv");
  return paths;
}

std::vector<std::string> write_ensemble(const std::string& prefix, const EnsembleFile& file,
                                        const EnsembleResult& result) {
  const std::vector<std::string> paths = ensemble_outputs(
      prefix, {result.compares, result.regression.has_value(), result.states.has_value(), !result.causes.empty()});
  std::vector<std::unique_ptr<AtomicFile>> files;
  std::vector<AtomicFile*> all;
  for (const std::string& path : paths) {
    files.push_back(std::make_unique<AtomicFile>(path));
    all.push_back(files.back().get());
  }
  std::size_t written = 0;
  const auto next = [&]() -> std::ostream& { return files[written++]->stream(); };
  next() << ensemble_json(file, result).dump(2) << '\n';
  write_surface(next(), file, result);
  write_residues(next(), result);
  if (result.compares) {
    write_patches(next(), file, result);
    write_series(next(), file, result);
  }
  if (result.states) {
    write_state_pairs(next(), file, *result.states);
    write_components(next(), file, *result.states);
  }
  if (result.regression) write_regression(next(), file, *result.regression);
  if (!result.causes.empty()) write_ensemble_causes(next(), result);
  commit_all(all);
  return paths;
}

}  // namespace espdiff
