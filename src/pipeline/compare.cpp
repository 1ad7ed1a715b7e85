// compare.cpp: the order of the stages for one pair.
#include "pipeline/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "align/superpose.h"
#include "base/error.h"

namespace espdiff {

FieldKind parse_field_kind(const std::string& text) {
  if (text == "density") return FieldKind::kDensity;
  if (text == "distance") return FieldKind::kDistance;
  if (text == "gvf" || text == "gvf2") {
    throw InputError("the field '" + text + "' (gradient vector flow) is not in this version; use density or distance");
  }
  throw InputError("unknown field '" + text + "'; use density or distance");
}

Interpolation parse_interpolation(const std::string& text) {
  if (text == "trilinear") return Interpolation::kTrilinear;
  if (text == "tricubic") return Interpolation::kTricubic;
  throw InputError("unknown interpolation '" + text + "'; use trilinear or tricubic");
}

CompareOptions thesis_options() {
  CompareOptions options;
  options.surface.project = false;
  options.surface.cavities = true;
  options.regularize.tangential_gain = options.deform.tangential_gain = 1;
  options.deform.rest_shape = false;
  options.deform_min_displacement = options.regularize_min_displacement = 1e-3;
  return options;
}

namespace {

/// A vertex farther than this from the other surface has no counterpart there.
constexpr double kCounterpartLimit_A = 1.0;
/// How far a vertex may move onto the analytic surface, in grid spacings: linear interpolation errs by less than a
/// tenth.
constexpr double kProjectionShare = 0.5;

/// Adds up the wall time of the stages.
class StageClock {
 public:
  explicit StageClock(std::vector<std::pair<std::string, double>>& times) : times_(times) {}
  /// Ends the current stage under this name.
  void lap(const std::string& stage) {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    const auto known =
        std::find_if(times_.begin(), times_.end(), [&](const auto& entry) { return entry.first == stage; });
    if (known == times_.end()) {
      times_.emplace_back(stage, ms);
    } else {
      known->second += ms;
    }
  }
  void finish() {
    times_.emplace_back("total",
                        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
  }

 private:
  std::vector<std::pair<std::string, double>>& times_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

void check_options(const SurfaceOptions& options) {
  if (!(options.radius_scale > 0))
    throw InputError("radius scale " + std::to_string(options.radius_scale) + " is not positive; 1 is usual");
  if (!(options.isovalue > 0))
    throw InputError("isovalue " + std::to_string(options.isovalue) + " is not positive; 0.5 is usual");
}

AtomsPtr upload(Engine& engine, const Molecule& molecule, const RigidTransform& to_common, double radius_scale) {
  std::vector<Vec3d> positions(molecule.size());
  std::vector<float> widths(molecule.size());
  std::vector<std::int32_t> residues(molecule.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    positions[i] = to_common.apply(molecule.positions[i]);
    widths[i] = static_cast<float>(radius_scale) * molecule.radii[i];
    residues[i] = molecule.atoms[i].residue;
  }
  return engine.upload_atoms(positions, widths, residues);
}

/// One molecule's surface in the common frame.
struct Surface {
  AtomsPtr atoms;
  GridPtr density;
  MeshPtr mesh;
  std::vector<ComponentSummary> components;  // all
  SurfaceSummary summary;
};

/// Leaves out closed cavities: components whose normals point into a void.
void drop_cavities(Engine& engine, Surface& surface) {
  std::vector<bool> keep;
  for (const ComponentSummary& component : surface.components) {
    keep.push_back(component.volume_A3 > 0);
    if (keep.back()) continue;
    ++surface.summary.n_cavities_left_out;
    surface.summary.cavity_area_A2 += component.area_A2;
  }
  if (surface.summary.n_cavities_left_out > 0) surface.mesh = engine.keep_components(surface.mesh, keep);
}

Surface build_surface(Engine& engine, const Molecule& molecule, const RigidTransform& to_common,
                      const SurfaceOptions& options, const Progress& progress, StageClock& clock) {
  check_options(options);
  Surface surface;
  const float isovalue = static_cast<float>(options.isovalue);
  progress.report("density", 0.0);
  surface.atoms = upload(engine, molecule, to_common, options.radius_scale);
  surface.density = engine.density(surface.atoms, options.grid_spacing_A);
  clock.lap("density");
  progress.report("surface", 0.0);
  surface.mesh = engine.isosurface(surface.density, isovalue);
  surface.components = engine.components(surface.mesh);
  if (!options.cavities) drop_cavities(engine, surface);
  clock.lap("surface");
  if (options.project)
    surface.mesh = engine.project(surface.mesh, surface.atoms, isovalue, kProjectionShare * options.grid_spacing_A);
  clock.lap("project");
  surface.summary.n_vertices = engine.n_vertices(surface.mesh);
  surface.summary.n_triangles = engine.n_triangles(surface.mesh);
  surface.summary.n_components = surface.components.size() - surface.summary.n_cavities_left_out;
  surface.summary.area_A2 = engine.area(surface.mesh);
  return surface;
}

DeformOptions with_threshold(DeformOptions deform, double min_displacement_in_spacings, double spacing_A) {
  deform.min_displacement_A = min_displacement_in_spacings * spacing_A;
  return deform;
}

MeshPtr regularize(Engine& engine, const Surface& surface, const SurfaceOptions& options, const DeformOptions& deform,
                   const Progress& progress, DeformReport* report) {
  const float isovalue = static_cast<float>(options.isovalue);
  const FieldPtr own = engine.density_field(surface.density, isovalue);
  MeshPtr mesh = engine.deform(surface.mesh, own, deform, "regularize", progress, report);
  if (options.project) mesh = engine.project(mesh, surface.atoms, isovalue, kProjectionShare * options.grid_spacing_A);
  return mesh;
}

/// Where both molecules meet: the source's principal frame, into which the target is superposed. Grids are thus laid
/// along axes of the shape itself, and a rigid motion of either input changes nothing but rounding.
struct CommonFrame {
  RigidTransform from_source, from_target;  // own frame -> common frame
};

CommonFrame align(const Molecule& source, const Molecule& target, AlignAtoms atoms, CompareResult& result) {
  CommonFrame frame;
  frame.from_source = principal_frame(source.positions);
  if (atoms == AlignAtoms::kNone) {
    // As given: RMSD over what pairs, if anything does.
    try {
      result.pairing = pair_atoms(source, target);
      result.rmsd_A = rmsd(source.positions, target.positions, result.pairing.pairs);
    } catch (const InputError&) {
      result.pairing.method = "none";
      result.rmsd_A = std::numeric_limits<double>::quiet_NaN();
    }
    frame.from_target = frame.from_source;
    return frame;
  }
  result.pairing = pair_atoms(source, target);
  const auto pairs = select_pairs(result.pairing, source, atoms);
  const Superposition superposition = superpose(source.positions, target.positions, pairs);
  result.source_to_target = superposition.transform;
  result.rmsd_A = superposition.rmsd_A;
  result.n_superposed_atoms = pairs.size();
  frame.from_target = compose(frame.from_source, inverse(superposition.transform));
  return frame;
}

/// Samples of both potentials at counterparts, in one unit.
struct Potentials {
  ScalarsPtr source, target;
};

Grid in_unit(const Grid& map, PotentialUnit unit, double temperature_K) {
  Grid converted = map;
  const float factor = static_cast<float>(conversion_factor(map.unit, unit, temperature_K));
  for (float& value : converted.values) value *= factor;
  converted.unit = unit;
  return converted;
}

std::size_t count_outside(const std::vector<float>& samples) {
  return static_cast<std::size_t>(
      std::count_if(samples.begin(), samples.end(), [](float value) { return !std::isfinite(value); }));
}

void require_coverage(const Grid& map, std::size_t n_outside, std::size_t n_vertices) {
  if (n_outside < n_vertices) return;
  throw InputError(
      map.name +
      ": the map does not cover the molecule: no vertex of the surface lies in it; compute the map around this "
      "molecule, in the coordinates of the structure file");
}

void check_maps(const CompareInput& source, const CompareInput& target) {
  if ((source.map == nullptr) != (target.map == nullptr)) {
    throw InputError(std::string("a potential map was given for the ") + (source.map != nullptr ? "source" : "target") +
                     " only; give both --source-map and --target-map, or neither to compare shapes alone");
  }
  if (source.map == nullptr || source.map->unit == target.map->unit) return;
  if (source.map->unit == PotentialUnit::kUnknown || target.map->unit == PotentialUnit::kUnknown) {
    throw InputError("the maps are in two units: " + to_string(source.map->unit) + " (" + source.map->name + ") and " +
                     to_string(target.map->unit) + " (" + target.map->name +
                     "); name the unknown one with --source-map-unit or --target-map-unit");
  }
}

Potentials sample_potentials(Engine& engine, const CompareInput& source, const CompareInput& target,
                             const CommonFrame& frame, const MeshPtr& source_mesh, const MeshPtr& mapped,
                             double temperature_K, CompareResult& result) {
  result.unit = source.map->unit;
  Grid converted;
  const Grid* target_map = target.map;
  if (target.map->unit != result.unit) {
    converted = in_unit(*target.map, result.unit, temperature_K);
    target_map = &converted;
  }
  Potentials potentials;
  potentials.source = engine.sample(engine.upload_map(*source.map, inverse(frame.from_source)), source_mesh);
  potentials.target = engine.sample(engine.upload_map(*target_map, inverse(frame.from_target)), mapped);
  result.surface.potential_source = engine.download(potentials.source);
  result.surface.potential_target = engine.download(potentials.target);
  result.n_outside_source_map = count_outside(result.surface.potential_source);
  result.n_outside_target_map = count_outside(result.surface.potential_target);
  require_coverage(*source.map, result.n_outside_source_map, result.surface.potential_source.size());
  require_coverage(*target.map, result.n_outside_target_map, result.surface.potential_target.size());
  result.has_potential = true;
  return potentials;
}

/// The limits within which a result counts as trustworthy.
struct Limits {
  static constexpr double kCorruptArea = 1e-3;
  static constexpr double kFlippedArea = 0.0;
  static constexpr double kMeanDistance_A = 0.05;
  static constexpr double kNoCounterpart = 0.05;
};

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * fraction);
  return text;
}
std::string angstrom(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g A", length);
  return text;
}

void judge(Certificate& c, const CompareResult& result) {
  const auto refuse = [&](bool bad, const std::string& reason) {
    if (bad) c.reasons.push_back(reason);
  };
  refuse(!c.converged, "the mapping did not converge; raise --max-iterations");
  refuse(c.corrupt_area_fraction > Limits::kCorruptArea, percent(c.corrupt_area_fraction) +
                                                             " of the mapped area is corrupt (limit " +
                                                             percent(Limits::kCorruptArea) + ")");
  refuse(c.flipped_area_fraction > Limits::kFlippedArea,
         percent(c.flipped_area_fraction) + " of the mapped area is flipped (limit 0 %)");
  refuse(c.mapped_to_target.mean > Limits::kMeanDistance_A,
         "the mapped surface lies " + angstrom(c.mapped_to_target.mean) + " from the target on average (limit " +
             angstrom(Limits::kMeanDistance_A) + ")");
  refuse(c.target_to_mapped.mean > Limits::kMeanDistance_A, "the target lies " + angstrom(c.target_to_mapped.mean) +
                                                                " from the mapped surface on average (limit " +
                                                                angstrom(Limits::kMeanDistance_A) + ")");
  refuse(c.no_counterpart_source > Limits::kNoCounterpart || c.no_counterpart_target > Limits::kNoCounterpart,
         percent(std::max(c.no_counterpart_source, c.no_counterpart_target)) +
             " of the area has no counterpart within " + angstrom(kCounterpartLimit_A) + " (limit " +
             percent(Limits::kNoCounterpart) + ")");
  const double n = static_cast<double>(result.surface.positions.size());
  const double outside = static_cast<double>(std::max(result.n_outside_source_map, result.n_outside_target_map));
  refuse(outside > 0, percent(outside / n) + " of the vertices lie outside a map");
  c.trustworthy = c.reasons.empty();
  c.not_checked = {"self_intersecting_pairs"};
}

Certificate certify(Engine& engine, const MeshPtr& mapped, const MeshPtr& target, const FitReport& fit) {
  Certificate c;
  c.corrupt_area_fraction = fit.corrupt_area_fraction;
  c.flipped_area_fraction = fit.flipped_area_fraction;
  c.irregularity_A = fit.irregularity_A;
  c.mapped_to_target = engine.distances(mapped, target, kCounterpartLimit_A);
  c.target_to_mapped = engine.distances(target, mapped, kCounterpartLimit_A);
  c.no_counterpart_source = c.mapped_to_target.area_fraction_beyond_limit;
  c.no_counterpart_target = c.target_to_mapped.area_fraction_beyond_limit;
  return c;
}

bool signs_differ(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

/// Averages over the valid area of each residue, weighted like the metrics: a third of each counted triangle at each
/// vertex.
std::vector<ResidueRow> residue_rows(const MappedSurface& s, std::size_t n_residues, bool has_potential) {
  std::vector<double> weight(s.positions.size(), 0.0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Triangle& v = s.triangles[t];
    bool counts = s.corrupt[t] == 0;
    for (const std::uint32_t c : v) {
      counts =
          counts && (!has_potential || (std::isfinite(s.potential_source[c]) && std::isfinite(s.potential_target[c])));
    }
    if (!counts) continue;
    const double area = 0.5 * norm(cross(s.positions[v[1]] - s.positions[v[0]], s.positions[v[2]] - s.positions[v[0]]));
    for (const std::uint32_t c : v) weight[c] += area / 3;
  }
  std::vector<ResidueRow> rows(n_residues);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (s.residue[v] < 0 || weight[v] <= 0) continue;
    ResidueRow& row = rows[static_cast<std::size_t>(s.residue[v])];
    row.area_A2 += weight[v];
    row.mean_displacement_A += weight[v] * static_cast<double>(s.displacement[v]);
    if (!has_potential) continue;
    const double a = static_cast<double>(s.potential_source[v]), b = static_cast<double>(s.potential_target[v]);
    row.mean_abs_difference += weight[v] * std::fabs(b - a);
    row.mean_signed_difference += weight[v] * (b - a);
    row.mean_source += weight[v] * a;
    row.mean_target += weight[v] * b;
    row.sign_change_area_fraction += signs_differ(a, b) ? weight[v] : 0;
  }
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ResidueRow& row = rows[r];
    row.residue = r;
    const double scale = row.area_A2 > 0 ? 1 / row.area_A2 : kNan;
    row.mean_displacement_A *= scale;
    for (double* value : {&row.mean_abs_difference, &row.mean_signed_difference, &row.mean_source, &row.mean_target,
                          &row.sign_change_area_fraction}) {
      *value *= has_potential ? scale : kNan;
    }
  }
  return rows;
}

void download_surface(Engine& engine, const MeshPtr& source, const MeshPtr& mapped, const CommonFrame& frame,
                      MappedSurface& surface) {
  const RigidTransform to_source = inverse(frame.from_source), to_target = inverse(frame.from_target);
  const Mesh mapped_mesh = engine.download(mapped);
  surface.triangles = mapped_mesh.triangles;
  for (const Vec3f& p : mapped_mesh.positions) surface.positions.push_back(to_target.apply(static_cast<Vec3d>(p)));
  for (const Vec3f& n : mapped_mesh.normals)
    surface.normals.push_back(static_cast<Vec3f>(to_target.rotate(static_cast<Vec3d>(n))));
  for (const Vec3f& p : engine.download(source).positions)
    surface.source_positions.push_back(to_source.apply(static_cast<Vec3d>(p)));
  surface.displacement = engine.download(engine.displacement(source, mapped));
}

}  // namespace

CompareResult compare(Engine& engine, const CompareInput& source, const CompareInput& target,
                      const CompareOptions& options, const Progress& progress) {
  CompareResult result;
  StageClock clock(result.time_ms);
  check_maps(source, target);
  progress.report("align", 0.0);
  const CommonFrame frame = align(*source.molecule, *target.molecule, options.align, result);
  clock.lap("align");

  const Surface source_surface =
      build_surface(engine, *source.molecule, frame.from_source, options.surface, progress, clock);
  const Surface target_surface =
      build_surface(engine, *target.molecule, frame.from_target, options.surface, progress, clock);
  result.source_surface = source_surface.summary;
  result.target_surface = target_surface.summary;
  const double spacing = options.surface.grid_spacing_A;
  const MeshPtr start = regularize(engine, source_surface, options.surface,
                                   with_threshold(options.regularize, options.regularize_min_displacement, spacing),
                                   progress, &result.regularize_report);
  clock.lap("regularize");

  const float isovalue = static_cast<float>(options.surface.isovalue);
  const FieldPtr field = options.field == FieldKind::kDensity
                             ? engine.density_field(target_surface.density, isovalue)
                             : engine.distance_field(target_surface.density, isovalue, target_surface.mesh,
                                                     options.distance_threshold_A, progress);
  clock.lap("field");
  MeshPtr mapped = engine.deform(start, field, with_threshold(options.deform, options.deform_min_displacement, spacing),
                                 "deform", progress, &result.deform_report);
  if (options.surface.project)
    mapped = engine.project(mapped, target_surface.atoms, isovalue, kProjectionShare * options.surface.grid_spacing_A);
  clock.lap("deform");

  progress.report("certificate", 0.0);
  const FitReport fit = engine.fit(mapped, target_surface.atoms, isovalue);
  result.area_mapped_A2 = fit.area_A2;
  result.certificate = certify(engine, mapped, target_surface.mesh, fit);
  result.certificate.converged = result.deform_report.converged;
  clock.lap("certificate");

  progress.report("metrics", 0.0);
  download_surface(engine, start, mapped, frame, result.surface);
  const std::vector<float> corrupt = engine.download(fit.corrupt);
  result.surface.corrupt.assign(corrupt.begin(), corrupt.end());
  result.surface.residue = engine.vertex_residues(start, source_surface.atoms);
  if (source.map != nullptr) {
    const Potentials potentials =
        sample_potentials(engine, source, target, frame, start, mapped, options.temperature_K, result);
    result.metrics = engine.compare(start, mapped, potentials.source, potentials.target, fit.corrupt);
    result.metrics_all = engine.compare(start, mapped, potentials.source, potentials.target, nullptr);
  }
  result.residues = residue_rows(result.surface, source.molecule->residues.size(), result.has_potential);
  judge(result.certificate, result);
  clock.lap("metrics");
  clock.finish();
  progress.report("metrics", 1.0);
  return result;
}

SurfaceResult make_surface(Engine& engine, const CompareInput& input, const SurfaceOptions& options,
                           const DeformOptions* regularize_options, const Progress& progress) {
  SurfaceResult result;
  StageClock clock(result.time_ms);
  const RigidTransform to_common = principal_frame(input.molecule->positions), from_common = inverse(to_common);
  clock.lap("align");
  Surface surface = build_surface(engine, *input.molecule, to_common, options, progress, clock);
  result.summary = surface.summary;
  result.components = surface.components;
  if (regularize_options != nullptr) {
    surface.mesh = regularize(engine, surface, options, *regularize_options, progress, &result.regularize_report);
    result.summary.area_A2 = engine.area(surface.mesh);
    clock.lap("regularize");
  }
  result.mesh = engine.download(surface.mesh);
  for (const Vec3f& p : result.mesh.positions) result.positions.push_back(from_common.apply(static_cast<Vec3d>(p)));
  for (Vec3f& n : result.mesh.normals) n = static_cast<Vec3f>(from_common.rotate(static_cast<Vec3d>(n)));
  for (std::size_t v = 0; v < result.positions.size(); ++v)
    result.mesh.positions[v] = static_cast<Vec3f>(result.positions[v]);
  result.residue = engine.vertex_residues(surface.mesh, surface.atoms);
  if (input.map != nullptr) {
    result.potential = engine.download(engine.sample(engine.upload_map(*input.map, from_common), surface.mesh));
    require_coverage(*input.map, count_outside(result.potential), result.potential.size());
  }
  clock.lap("attributes");
  clock.finish();
  progress.report("attributes", 1.0);
  return result;
}

}  // namespace espdiff
