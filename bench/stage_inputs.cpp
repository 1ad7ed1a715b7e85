// stage_inputs.cpp: makes the inputs of the stages.
#include "stage_inputs.h"

#include <cmath>
#include <filesystem>

#include "base/progress.h"
#include "cuda/certificate/mesh_checks.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "io/structures/structure_file.h"
#include "real_pairs.h"
#include "synthetic_protein.h"

namespace espdiff_bench {
namespace {

using espdiff::Vec3d;

void centre(espdiff::Molecule& molecule) {
  Vec3d sum{};
  for (const Vec3d& p : molecule.positions) sum += p;
  const Vec3d centroid = (1.0 / static_cast<double>(molecule.size())) * sum;
  for (Vec3d& p : molecule.positions) p = p - centroid;
}

Side make_side(espdiff::Engine& engine, const espdiff::Molecule& molecule, const StageInputs& inputs) {
  Side side;
  side.molecule = molecule;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    side.widths.push_back(static_cast<float>(inputs.options.surface.radius_scale) * molecule.radii[i]);
    side.residues.push_back(molecule.atoms[i].residue);
  }
  side.atoms = engine.upload_atoms(molecule.positions, side.widths, side.residues);
  side.density = engine.density(side.atoms, inputs.spacing());
  side.raw = engine.isosurface(side.density, inputs.isovalue());
  std::vector<bool> keep;
  for (const espdiff::ComponentSummary& component : engine.components(side.raw))
    keep.push_back(component.volume_A3 > 0);
  side.surface =
      engine.project(engine.keep_components(side.raw, keep), side.atoms, inputs.isovalue(), inputs.projection_limit());
  return side;
}

}  // namespace

std::vector<Case> cases() {
  std::vector<Case> all{{"1k", 1000, "", 0},    {"5k", 5000, "", 0},      {"20k", 20000, "", 10.7},
                        {"50k", 50000, "", 38}, {"100k", 100000, "", 77}, {"123k", 123000, "", 0}};
  const std::string file = data_folder() + "/ref_apbs/1tca.pqr";
  if (std::filesystem::exists(file)) all.push_back({"1tca", 0, file, 4.3});
  const std::string tim = data_folder() + "/pair_tim_maps/scTIM_chainA.pqr";
  if (std::filesystem::exists(tim)) all.push_back({"tim", 0, tim, 0});
  return all;
}

std::vector<BenchDevice> devices() {
  std::vector<BenchDevice> all{{"threads:1", espdiff::DeviceChoice::kCpu, 1},
                               {"threads:2", espdiff::DeviceChoice::kCpu, 2}};
  if (espdiff::cuda_status().available) all.push_back({"cuda", espdiff::DeviceChoice::kCuda, 0});
  return all;
}

StageInputs::StageInputs(const Case& of, const BenchDevice& device)
    : engine(espdiff::select_engine(device.request, device.n_threads)) {
  constexpr double kDisplacement_A = 0.5;
  options.regularize.min_displacement_A = options.regularize_min_displacement * spacing();
  options.deform.min_displacement_A = options.deform_min_displacement * spacing();
  const espdiff::Progress silent;
  espdiff::Molecule molecule = of.n_atoms > 0 ? synthetic_protein(of.n_atoms) : espdiff::read_structure(of.file);
  centre(molecule);
  source = make_side(*engine, molecule, *this);
  target = make_side(*engine, displaced_smoothly(molecule, kDisplacement_A), *this);
  const espdiff::Mesh raw = engine->download(source.raw);
  fault = espdiff_test::manifold_fault(raw);
  n_components = engine->components(source.raw).size();
  own_field = engine->density_field(source.density, isovalue());
  target_density_field = engine->density_field(target.density, isovalue());
  target_distance_field =
      engine->distance_field(target.density, isovalue(), target.surface, options.distance_threshold_A, silent);
  espdiff::DeformReport report;
  start = engine->project(engine->deform(source.surface, own_field, options.regularize, "regularize", silent, &report),
                          source.atoms, isovalue(), projection_limit());
  mapped = engine->project(engine->deform(start, target_distance_field, options.deform, "deform", silent, &report),
                           target.atoms, isovalue(), projection_limit());
  map = smooth_map(molecule);
#if defined(ESPDIFF_HAVE_VTK)
  const espdiff::Grid density = engine->download(source.density);
  marching_cubes = vtk_marching_cubes(density, isovalue());
  flying_edges = vtk_flying_edges(density, isovalue());
#endif
}

const StageInputs& stage_inputs(const Case& of, const BenchDevice& device) {
  static std::unique_ptr<StageInputs> last;
  static std::string last_key;
  const std::string key = of.name + "/" + device.name;
  if (key != last_key) {
    last.reset();  // two of the largest would need twice the memory
    last = std::make_unique<StageInputs>(of, device);
    last_key = key;
  }
  return *last;
}

}  // namespace espdiff_bench
