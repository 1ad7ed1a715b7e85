// build_surface.cpp: density, surface, components, projection and regularization of one molecule.
#include "mapping/build_surface.h"

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "base/formatted.h"
#include "engine/engine.h"
#include "mapping/map_recipe.h"
#include "mapping/side_maps.h"
#include "options/options.h"

namespace espdiff {
namespace {

void check_options(const SurfaceOptions& options) {
  if (!(options.radius_scale > 0))
    throw InputError("radius scale " + formatted(options.radius_scale) + " is not positive; 1 is usual");
  if (!(options.isovalue > 0))
    throw InputError("isovalue " + formatted(options.isovalue) + " is not positive; 0.5 is usual");
}

AtomsPtr upload(Engine& engine, const Molecule& molecule, const RigidTransform& to_common, double radius_scale,
                const std::vector<std::int32_t>& labels) {
  std::vector<Vec3d> positions(molecule.size());
  std::vector<float> widths(molecule.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    positions[i] = to_common.apply(molecule.positions[i]);
    widths[i] = static_cast<float>(radius_scale) * molecule.radii[i];
  }
  return engine.upload_atoms(positions, widths, labels);
}

std::vector<std::int32_t> residues_of_atoms(const Molecule& molecule) {
  std::vector<std::int32_t> residues(molecule.size());
  for (std::size_t i = 0; i < molecule.size(); ++i) residues[i] = molecule.atoms[i].residue;
  return residues;
}

/// Removes closed cavities: components whose normals point into a void.
void drop_cavities(Engine& engine, Surface& surface) {
  std::vector<bool> keep;
  for (const ComponentSummary& component : surface.components) {
    keep.push_back(component.volume_A3 > 0);
    if (keep.back()) continue;
    ++surface.summary.n_cavities_left_out;
    surface.summary.cavity_area_A2 += component.area_A2;
  }
  if (surface.summary.n_cavities_left_out > 0) surface.mesh = engine.keep_components(surface.whole, keep);
}

}  // namespace

std::vector<std::int32_t> vertex_labels(Engine& engine, const Surface& surface, const MeshPtr& mesh,
                                        const Molecule& molecule, const RigidTransform& to_common,
                                        const std::vector<std::int32_t>& labels) {
  return engine.vertex_residues(mesh, upload(engine, molecule, to_common, surface.radius_scale, labels));
}

Surface build_surface(Engine& engine, const Molecule& molecule, const RigidTransform& to_common,
                      const SurfaceOptions& options, const Progress& progress, StageClock& clock) {
  check_options(options);
  Surface surface;
  const float isovalue = static_cast<float>(options.isovalue);
  progress.report("density", 0.0);
  surface.radius_scale = options.radius_scale;
  surface.atoms = upload(engine, molecule, to_common, options.radius_scale, residues_of_atoms(molecule));
  surface.density = engine.density(surface.atoms, options.grid_spacing_A);
  clock.lap("density");
  progress.report("surface", 0.0);
  surface.whole = engine.isosurface(surface.density, isovalue);
  surface.components = engine.components(surface.whole);
  clock.lap("surface");
  if (options.project)
    surface.whole = engine.project(surface.whole, surface.atoms, isovalue, kProjectionShare * options.grid_spacing_A);
  surface.mesh = surface.whole;
  if (!options.cavities) drop_cavities(engine, surface);
  clock.lap("project");
  surface.summary.n_vertices = engine.n_vertices(surface.mesh);
  surface.summary.n_triangles = engine.n_triangles(surface.mesh);
  surface.summary.n_components = surface.components.size() - surface.summary.n_cavities_left_out;
  surface.summary.area_A2 = engine.area(surface.mesh);
  return surface;
}

MeshPtr regularize(Engine& engine, const Surface& surface, const MeshPtr& given, const CompareOptions& options,
                   const Progress& progress, DeformReport* report) {
  const float isovalue = static_cast<float>(options.surface.isovalue);
  const double spacing = options.surface.grid_spacing_A;
  const FieldPtr own = engine.density_field(surface.density, isovalue);
  DeformOptions iteration = options.regularize;
  iteration.min_displacement_A = options.regularize_min_displacement * spacing;
  MeshPtr mesh = engine.deform(given, own, iteration, "regularize", progress, report);
  if (report != nullptr) report->path_length = nullptr;  // results may outlive the engine
  if (options.surface.project) mesh = engine.project(mesh, surface.atoms, isovalue, kProjectionShare * spacing);
  return mesh;
}

SurfaceResult make_surface(Engine& engine, const CompareInput& input, const CompareOptions& options, bool regularized,
                           const Progress& progress) {
  SurfaceResult result;
  StageClock clock(result.time_ms);
  const RigidTransform to_common = principal_frame(input.molecule->positions), from_common = inverse(to_common);
  clock.lap("align");
  Surface surface = build_surface(engine, *input.molecule, to_common, options.surface, progress, clock);
  result.summary = surface.summary;
  result.components = surface.components;
  if (regularized) {
    surface.mesh = regularize(engine, surface, surface.mesh, options, progress, &result.regularize_report);
    result.summary.area_A2 = engine.area(surface.mesh);
    clock.lap("regularize");
  }
  result.mesh = engine.download(surface.mesh);
  for (const Vec3f& p : result.mesh.positions) result.positions.push_back(from_common.apply(static_cast<Vec3d>(p)));
  result.mesh.normals =
      engine.level_set_normals(surface.mesh, surface.atoms, static_cast<float>(options.surface.isovalue));
  for (Vec3f& n : result.mesh.normals) n = static_cast<Vec3f>(from_common.rotate(static_cast<Vec3d>(n)));
  for (std::size_t v = 0; v < result.positions.size(); ++v)
    result.mesh.positions[v] = static_cast<Vec3f>(result.positions[v]);
  result.residue = engine.vertex_residues(surface.mesh, surface.atoms);
  if (has_map(input)) {
    result.unit = unit_of(input);
    const MadeMap made = device_map(engine, input, from_common, {}, result.unit, options.temperature_K, progress);
    if (input.make_map) {
      result.potential_label = potential_label(made.recipe);
      result.is_vacuum = is_vacuum(made.recipe);
    }
    result.potential = engine.download(engine.sample(made.map, surface.mesh));
    result.outside_map =
        static_cast<double>(count_outside(input, result.potential)) / static_cast<double>(result.potential.size());
  }
  clock.lap("attributes");
  clock.finish();
  progress.report("attributes", 1.0);
  return result;
}

Grid make_density(Engine& engine, const Molecule& molecule, const SurfaceOptions& options) {
  check_options(options);
  RigidTransform to_centre;  // translation only: single precision needs an origin nearby
  for (const Vec3d& p : molecule.positions) to_centre.translation += (-1.0 / static_cast<double>(molecule.size())) * p;
  Grid density = engine.download(engine.density(
      upload(engine, molecule, to_centre, options.radius_scale, residues_of_atoms(molecule)), options.grid_spacing_A));
  density.lattice.origin = density.lattice.origin - to_centre.translation;
  density.name = molecule.name;
  return density;
}

}  // namespace espdiff
