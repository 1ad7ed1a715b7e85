// determinism.cpp: the same bits for any number of threads and on repetition, stage by stage.
#include <doctest/doctest.h>

#include <limits>
#include <map>
#include <string>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/field_stage.h"
#include "engine/surface_stage.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

using Hashes = std::map<std::string, std::uint64_t>;

std::uint64_t hash_of(const espdiff::Metrics& m) {
  return Hash()
      .add(m.area_A2)
      .add(m.mean_abs_difference)
      .add(m.rms_difference)
      .add(m.mean_signed_difference)
      .add(m.sign_change_area_fraction)
      .add(m.hodgkin_index)
      .add(m.carbo_index)
      .add(m.mean_displacement_A)
      .add(m.mean_path_length_A)
      .add(m.correlation)
      .value();
}

/// A map of a few waves around the origin.
espdiff::Grid wave_map() {
  espdiff::Grid grid;
  grid.lattice.size = {40, 40, 40};
  grid.lattice.origin = {-39, -39, -39};
  grid.lattice.step = {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
  for (std::size_t p = 0; p < grid.lattice.n_points(); ++p) {
    const Vec3d at = lattice_point(grid.lattice, p);
    grid.values.push_back(static_cast<float>(std::sin(0.3 * at.x) * std::cos(0.2 * at.y) + 0.02 * at.z));
  }
  return grid;
}

Hashes run_all_stages(Engine& engine, const AtomSet& source_atoms, const AtomSet& target_atoms) {
  Hashes hashes;
  const auto hash_mesh = [&](const std::string& stage, const espdiff::MeshPtr& mesh) {
    hashes[stage] = Hash().add(engine.download(mesh)).value();
  };
  const auto source = upload(engine, source_atoms), target = upload(engine, target_atoms);
  const auto density = engine.density(source, 1.0), target_density = engine.density(target, 1.0);
  hashes["density"] = Hash().add(engine.download(density).values).value();
  auto surface = engine.isosurface(density, 0.5F);
  hash_mesh("isosurface", surface);
  const auto components = engine.components(surface);
  Hash component_hash;
  std::vector<bool> keep;
  for (const auto& c : components) {
    component_hash.add(c.n_vertices).add(c.n_triangles).add(c.area_A2).add(c.volume_A3);
    keep.push_back(c.volume_A3 > 0);
  }
  hashes["components"] = component_hash.value();
  surface = engine.keep_components(surface, keep);
  hash_mesh("keep_components", surface);
  surface = engine.project(surface, source, 0.5F, 0.5);
  hash_mesh("project", surface);
  const auto own = engine.density_field(density, 0.5F);
  hashes["density field"] = Hash().add(engine.download(own).values).value();
  espdiff::DeformOptions options;
  options.max_iterations = 30;
  const auto start = engine.deform(surface, own, options, "regularize", {}, nullptr);
  hash_mesh("regularize", start);
  const auto target_surface = engine.isosurface(target_density, 0.5F);
  const auto distance = engine.distance_field(target_density, 0.5F, target_surface, 0.75, {});
  hashes["distance field"] = Hash().add(engine.download(distance).values).value();
  espdiff::VectorFlowReport flow_report;
  espdiff::VectorFlowOptions flow;
  flow.max_sweeps = 60;
  const auto flowing = engine.gvf_field(target_density, density, 0.5F, flow, {}, &flow_report);
  hashes["gradient vector flow"] = Hash()
                                       .add(engine.download_gradient(flowing))
                                       .add(engine.download(flowing).values)
                                       .add(flow_report.residual)
                                       .value();
  for (const auto interpolation : {espdiff::Interpolation::kTrilinear, espdiff::Interpolation::kTricubic}) {
    options.interpolation = interpolation;
    espdiff::DeformReport report;
    const auto mapped = engine.deform(start, distance, options, "deform", {}, &report);
    const std::string suffix = interpolation == espdiff::Interpolation::kTrilinear ? ", trilinear" : ", tricubic";
    hash_mesh("deform" + suffix, mapped);
    hashes["deform report" + suffix] =
        Hash().add(report.iterations).add(report.mean_displacement_A).add(engine.download(report.path_length)).value();
    const auto finer = engine.subdivide(start, mapped, 1.0);
    hash_mesh("subdivide, source" + suffix, finer.source);
    hash_mesh("subdivide, mapped" + suffix, finer.mapped);
    const auto fit = engine.fit(mapped, target, 0.5F);
    hashes["fit" + suffix] = Hash()
                                 .add(engine.download(fit.corrupt))
                                 .add(fit.corrupt_area_fraction)
                                 .add(fit.flipped_area_fraction)
                                 .add(fit.irregularity_A)
                                 .add(fit.area_A2)
                                 .value();
    const auto d = engine.distances(mapped, target_surface, 0.2);
    hashes["distances" + suffix] = Hash().add(d.mean).add(d.p95).add(d.max).add(d.area_fraction_beyond_limit).value();
    const auto map = engine.upload_map(wave_map(), rigid({0, 0.6, 0.8}, 0.4, {1, 2, 3}));
    const auto a = engine.sample(map, start), b = engine.sample(map, mapped);
    hashes["sample" + suffix] = Hash().add(engine.download(a)).add(engine.download(b)).value();
    hashes["compare" + suffix] = hash_of(engine.compare(start, mapped, a, b, fit.corrupt, report.path_length));
    hashes["displacement" + suffix] = Hash().add(engine.download(engine.displacement(start, mapped))).value();
  }
  hashes["area"] = Hash().add(engine.area(start)).value();
  espdiff::AtomValues values{source_atoms.positions, source_atoms.widths, {}};
  for (std::size_t i = 0; i < values.positions.size(); ++i)
    values.values.push_back(i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(values.positions[i].x));
  hashes["field, mean"] = Hash().add(engine.atom_field(start, values)).value();
  values.weight = espdiff::AtomWeight::kDecaySum;
  hashes["field, sum"] = Hash().add(engine.atom_field(start, values)).value();
  hashes["residues"] = Hash().add(engine.vertex_residues(start, source)).value();
  return hashes;
}

void check_same(const Hashes& expected, const Hashes& found, const std::string& what) {
  REQUIRE(found.size() == expected.size());
  for (const auto& [stage, hash] : expected) {
    const std::string captured_stage = stage;  // a structured binding cannot be captured
    CAPTURE(captured_stage);
    CAPTURE(what);
    CHECK(found.at(stage) == hash);
  }
}

}  // namespace

TEST_SUITE_BEGIN("determinism");

TEST_CASE("every stage gives the same bits for 1, 2 and 4 threads, and again") {
  const auto path = real_input("series19_ubq_2k39/m00.pqr"), other = real_input("series19_ubq_2k39/m01.pqr");
  const AtomSet source = path ? read_atoms(*path) : random_cloud(400, 150);
  const AtomSet target = path ? read_atoms(*other) : random_cloud(400, 151);
  const auto one = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const Hashes expected = run_all_stages(*one, source, target);
  check_same(expected, run_all_stages(*one, source, target), "1 thread, again");
  for (const int n_threads : {2, 4}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
    check_same(expected, run_all_stages(*engine, source, target), std::to_string(n_threads) + " threads");
  }
}

TEST_CASE("every back end repeats itself to the bit and finds the CPU's topology") {
  const AtomSet source = random_cloud(150, 152), target = random_cloud(150, 153);
  std::vector<Mesh> surfaces;
  for (const auto& engine : back_ends()) {
    check_same(run_all_stages(*engine, source, target), run_all_stages(*engine, source, target), engine->back_end());
    surfaces.push_back(engine->download(engine->isosurface(engine->density(upload(*engine, source), 1.0), 0.5F)));
    CHECK(surfaces.back().triangles == surfaces.front().triangles);
  }
}

TEST_CASE("two engines of different thread counts can be used in turn") {
  const auto one = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1),
             two = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const AtomSet atoms = random_cloud(200, 154);
  const auto a = upload(*one, atoms), b = upload(*two, atoms);
  const auto density_one = one->density(a, 1.0), density_two = two->density(b, 1.0);
  CHECK(one->n_threads() == 1);
  CHECK(two->n_threads() == 2);
  CHECK(Hash().add(one->download(one->isosurface(density_one, 0.5F))).value() ==
        Hash().add(two->download(two->isosurface(density_two, 0.5F))).value());
}

TEST_SUITE_END();
