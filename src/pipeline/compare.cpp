// compare.cpp: the order of the stages for one pair.
#include "pipeline/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "align/superpose.h"
#include "base/error.h"
#include "pipeline/build_surface.h"
#include "pipeline/certificate.h"
#include "pipeline/residue_rows.h"

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

DeformOptions with_threshold(DeformOptions deform, double min_displacement_in_spacings, double spacing_A) {
  deform.min_displacement_A = min_displacement_in_spacings * spacing_A;
  return deform;
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

}  // namespace espdiff
