// stages.cpp: times every stage of the pipeline and the whole of it, and prints beside each time how good its result
// is.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/version.h"
#include "machine_peak.h"
#include "renumbered.h"
#include "stage_inputs.h"
#include "work_model.h"

namespace {

using benchmark::State;
using espdiff::DeformOptions;
using espdiff::MeshPtr;
using espdiff_bench::Case;
using espdiff_bench::StageInputs;

const espdiff::Progress kSilent;

/// Times a call by the engine's clock: on a GPU by its events.
template <typename Call>
void time_calls(State& state, const StageInputs& in, Call call, int n_in_call = 1) {
  for (auto _ : state) state.SetIterationTime(1e-3 * in.engine->elapsed_ms(call) / n_in_call);
}

void count_work(State& state, const espdiff_bench::Work& work) {
  state.counters["work_bytes"] = work.bytes;
  state.counters["work_operations"] = work.operations;
}

/// One benchmark: called with the inputs of a case; loops over `state`.
struct Stage {
  std::string name;
  std::function<void(State&, const StageInputs&)> run;
  bool slow = false;  ///< seconds rather than milliseconds: fewer repetitions
  bool once = false;  ///< a call is long enough to be timed by itself
};

void count_mesh(State& state, const StageInputs& in, const MeshPtr& mesh) {
  state.counters["vertices"] = static_cast<double>(in.engine->n_vertices(mesh));
  state.counters["triangles"] = static_cast<double>(in.engine->n_triangles(mesh));
}

void count_fit(State& state, const espdiff::FitReport& fit) {
  state.counters["corrupt_percent"] = 100 * fit.corrupt_area_fraction;
  state.counters["flipped_percent"] = 100 * fit.flipped_area_fraction;
}

void density(State& state, const StageInputs& in) {
  espdiff::GridPtr grid;
  time_calls(state, in, [&] { grid = in.engine->density(in.source.atoms, in.spacing()); });
  state.counters["lattice_points"] = static_cast<double>(in.engine->download(grid).values.size());
  count_work(state, espdiff_bench::density_work(in));
}

void upload_atoms(State& state, const StageInputs& in) {
  time_calls(state, in,
             [&] { in.engine->upload_atoms(in.source.molecule.positions, in.source.widths, in.source.residues); });
  state.counters["atoms"] = static_cast<double>(in.source.molecule.size());
}

void count_surface(State& state, const StageInputs& in) {
  count_mesh(state, in, in.source.raw);
  state.counters["components"] = static_cast<double>(in.n_components);
  state.counters["closed_manifold"] = in.fault.empty() ? 1 : 0;
  if (in.marching_cubes.n_triangles == 0) return;
  state.counters["marching_cubes_triangles"] = static_cast<double>(in.marching_cubes.n_triangles);
  state.counters["marching_cubes_ms"] = in.marching_cubes.ms;
  state.counters["flying_edges_ms"] = in.flying_edges.ms;
}

void isosurface(State& state, const StageInputs& in) {
  time_calls(state, in, [&] { in.engine->isosurface(in.source.density, in.isovalue()); });
  count_surface(state, in);
  count_work(state, espdiff_bench::isosurface_work(in));
}

/// From atoms to triangles, the sorting of the atoms included: what a peer's surface has to be set against. The bar is
/// the peer's time, times our triangles over those of marching cubes on the same grid.
void density_and_isosurface(State& state, const StageInputs& in, double quicksurf_ms) {
  time_calls(state, in, [&] {
    const auto atoms = in.engine->upload_atoms(in.source.molecule.positions, in.source.widths, in.source.residues);
    in.engine->isosurface(in.engine->density(atoms, in.spacing()), in.isovalue());
  });
  count_surface(state, in);
  if (in.marching_cubes.n_triangles == 0) return;
  const double ratio =
      static_cast<double>(in.engine->n_triangles(in.source.raw)) / static_cast<double>(in.marching_cubes.n_triangles);
  state.counters["triangle_ratio"] = ratio;
  if (quicksurf_ms > 0 && in.engine->n_threads() == 1) state.counters["bar_ms"] = quicksurf_ms * ratio;
}

void components(State& state, const StageInputs& in) {
  time_calls(state, in, [&] { in.engine->components(in.source.raw); });
  state.counters["components"] = static_cast<double>(in.n_components);
}

void project(State& state, const StageInputs& in) {
  MeshPtr mesh;
  time_calls(state, in,
             [&] { mesh = in.engine->project(in.source.raw, in.source.atoms, in.isovalue(), in.projection_limit()); });
  count_mesh(state, in, mesh);
  count_fit(state, in.engine->fit(mesh, in.source.atoms, in.isovalue()));
}

void density_field(State& state, const StageInputs& in) {
  time_calls(state, in, [&] { in.engine->density_field(in.target.density, in.isovalue()); });
  count_work(state, espdiff_bench::density_field_work(in));
}

void distance_field(State& state, const StageInputs& in) {
  time_calls(state, in, [&] {
    in.engine->distance_field(in.target.density, in.isovalue(), in.target.surface, in.options.distance_threshold_A,
                              kSilent);
  });
}

/// The mean time of an iteration over a run of many, as the whole is run.
void per_iteration(State& state, const StageInputs& in, const MeshPtr& mesh, const espdiff::FieldPtr& field,
                   DeformOptions options) {
  constexpr int kIterations = 50;
  options.max_iterations = kIterations;
  options.min_displacement_A = 0;
  espdiff::DeformReport report;
  time_calls(
      state, in, [&] { in.engine->deform(mesh, field, options, "deform", kSilent, &report); }, kIterations);
  count_mesh(state, in, mesh);
}

void count_report(State& state, const espdiff::DeformReport& report) {
  state.counters["deform_iterations"] = report.iterations;
  state.counters["converged"] = report.converged ? 1 : 0;
}

void regularize(State& state, const StageInputs& in) {
  espdiff::DeformReport report;
  MeshPtr mesh;
  time_calls(state, in, [&] {
    mesh = in.engine->deform(in.source.surface, in.own_field, in.options.regularize, "regularize", kSilent, &report);
  });
  count_mesh(state, in, mesh);
  count_report(state, report);
  const espdiff::FitReport fit = in.engine->fit(mesh, in.source.atoms, in.isovalue());
  count_fit(state, fit);
  state.counters["irregularity_A"] = fit.irregularity_A;
}

void deform(State& state, const StageInputs& in, const espdiff::FieldPtr& field) {
  espdiff::DeformReport report;
  MeshPtr mesh;
  time_calls(state, in,
             [&] { mesh = in.engine->deform(in.start, field, in.options.deform, "deform", kSilent, &report); });
  count_mesh(state, in, mesh);
  count_report(state, report);
  count_fit(state, in.engine->fit(mesh, in.target.atoms, in.isovalue()));
  state.counters["mean_distance_A"] = in.engine->distances(mesh, in.target.surface, 1.0).mean;
}

void fit(State& state, const StageInputs& in) {
  espdiff::FitReport report;
  time_calls(state, in, [&] { report = in.engine->fit(in.mapped, in.target.atoms, in.isovalue()); });
  count_fit(state, report);
  count_work(state, espdiff_bench::fit_work(in));
}

/// Both directions, as the certificate takes them.
void distances(State& state, const StageInputs& in) {
  espdiff::DistanceSummary there, back;
  time_calls(state, in, [&] {
    there = in.engine->distances(in.mapped, in.target.surface, 1.0);
    back = in.engine->distances(in.target.surface, in.mapped, 1.0);
  });
  state.counters["mean_distance_A"] = there.mean;
  state.counters["mean_distance_back_A"] = back.mean;
  state.counters["max_distance_back_A"] = back.max;
}

void self_intersections(State& state, const StageInputs& in) {
  espdiff::IntersectionReport report;
  time_calls(state, in, [&] { report = in.engine->self_intersections(in.mapped); });
  state.counters["pairs"] = static_cast<double>(report.n_pairs);
}

/// Sampling of both potentials and their comparison; the maps are on the device already.
void sample_and_metrics(State& state, const StageInputs& in) {
  const auto map = in.engine->upload_map(in.map, espdiff::RigidTransform{});
  const auto corrupt = in.engine->fit(in.mapped, in.target.atoms, in.isovalue()).corrupt;
  espdiff::Metrics metrics;
  time_calls(state, in, [&] {
    metrics = in.engine->compare(in.start, in.mapped, in.engine->sample(map, in.start),
                                 in.engine->sample(map, in.mapped), corrupt);
  });
  state.counters["mean_displacement_A"] = metrics.mean_displacement_A;
  state.counters["area_A2"] = metrics.area_A2;
}

void vertex_residues(State& state, const StageInputs& in) {
  time_calls(state, in, [&] { in.engine->vertex_residues(in.start, in.source.atoms); });
}

/// Everything from atoms and maps to metrics and certificate, with the pipeline's default options.
void compare(State& state, const StageInputs& in) {
  espdiff::CompareResult result;
  time_calls(state, in, [&] {
    result = espdiff::compare(*in.engine, {&in.source.molecule, &in.map}, {&in.target.molecule, &in.map}, in.options,
                              kSilent);
  });
  const espdiff::Certificate& c = result.certificate;
  state.counters["vertices"] = static_cast<double>(result.surface.positions.size());
  state.counters["rmsd_A"] = result.rmsd_A;
  state.counters["corrupt_percent"] = 100 * c.corrupt_area_fraction;
  state.counters["flipped_percent"] = 100 * c.flipped_area_fraction;
  state.counters["mean_distance_A"] = c.mapped_to_target.mean;
  state.counters["mean_distance_back_A"] = c.target_to_mapped.mean;
  state.counters["deform_iterations"] = result.deform_report.iterations;
  state.counters["regularize_iterations"] = result.regularize_report.iterations;
  state.counters["converged"] = c.converged ? 1 : 0;
  for (const auto& [stage, ms] : result.time_ms) state.counters["ms_" + stage] = ms;
}

/// In the order of the data flow.
std::vector<Stage> stages(double quicksurf_ms) {
  const auto tricubic = [](DeformOptions options) {
    options.interpolation = espdiff::Interpolation::kTricubic;
    return options;
  };
  return {
      {"upload_atoms", upload_atoms},
      {"density", density},
      {"isosurface", isosurface},
      {"density_and_isosurface", [=](State& s, const StageInputs& in) { density_and_isosurface(s, in, quicksurf_ms); }},
      {"components", components},
      {"project", project},
      {"density_field", density_field},
      {"distance_field", distance_field},
      {"regularize_iteration",
       [](State& s, const StageInputs& in) {
         per_iteration(s, in, in.source.surface, in.own_field, in.options.regularize);
       },
       false, true},
      {"regularize", regularize, true},
      {"deform_iteration",
       [](State& s, const StageInputs& in) {
         per_iteration(s, in, in.start, in.target_distance_field, in.options.deform);
         count_work(s, espdiff_bench::deform_iteration_work(in, false));
       },
       false, true},
      {"deform_iteration_along_a_curve",
       [](State& s, const StageInputs& in) {
         const MeshPtr mesh = in.engine->upload_mesh(espdiff_bench::along_a_curve(in.engine->download(in.start)));
         per_iteration(s, in, mesh, in.target_distance_field, in.options.deform);
       },
       false, true},
      {"deform_iteration_shuffled",
       [](State& s, const StageInputs& in) {
         const MeshPtr mesh = in.engine->upload_mesh(espdiff_bench::shuffled(in.engine->download(in.start)));
         per_iteration(s, in, mesh, in.target_distance_field, in.options.deform);
       },
       false, true},
      {"deform_iteration_tricubic",
       [=](State& s, const StageInputs& in) {
         per_iteration(s, in, in.start, in.target_distance_field, tricubic(in.options.deform));
         count_work(s, espdiff_bench::deform_iteration_work(in, true));
       },
       false, true},
      {"deform_density_field", [](State& s, const StageInputs& in) { deform(s, in, in.target_density_field); }, true},
      {"deform_distance_field", [](State& s, const StageInputs& in) { deform(s, in, in.target_distance_field); }, true},
      {"fit", fit},
      {"distances", distances},
      {"self_intersections", self_intersections},
      {"sample_and_metrics", sample_and_metrics},
      {"vertex_residues", vertex_residues},
      {"compare", compare, true},
  };
}

void register_benchmarks() {
  constexpr int kRepetitions = 5, kSlowRepetitions = 3;
  constexpr std::size_t kLarge = 30000;  // atoms; seconds per stage: once will do
  for (const Case& of : espdiff_bench::cases()) {
    for (const espdiff_bench::BenchDevice& device : espdiff_bench::devices()) {
      for (const Stage& stage : stages(of.quicksurf_ms)) {
        const auto run = [=](State& state) {
          try {
            stage.run(state, espdiff_bench::stage_inputs(of, device));
          } catch (const std::exception& error) {
            state.SkipWithError(error.what());
          }
        };
        const std::string name = stage.name + "/" + of.name + "/" + device.name;
        auto* registered = benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
        const int slow = of.n_atoms > kLarge ? 1 : kSlowRepetitions;
        registered->Repetitions(stage.slow ? slow : kRepetitions)->ReportAggregatesOnly(true);
        if (stage.slow || stage.once) {
          registered->Iterations(1);
        } else {
          registered->MinTime(0.05);
        }
        registered->UseManualTime();
      }
    }
  }
}

std::string cpu_model() {
  std::ifstream in("/proc/cpuinfo");
  std::string line;
  while (std::getline(in, line)) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

void add_peak(const std::string& device, const espdiff_bench::MachinePeak& peak) {
  benchmark::AddCustomContext("bandwidth_GBps " + device, std::to_string(peak.bandwidth_GBps));
  benchmark::AddCustomContext("arithmetic_Gops " + device, std::to_string(peak.arithmetic_Gops));
}

/// The roofs that stages are read against, measured in the same run.
void add_peaks() {
  for (const espdiff_bench::BenchDevice& device : espdiff_bench::devices()) {
    if (device.n_threads > 0) add_peak(device.name, espdiff_bench::cpu_peak(device.n_threads));
#if defined(ESPDIFF_HAVE_CUDA)
    if (device.n_threads == 0) {
      add_peak(device.name, espdiff_bench::cuda_peak());
      benchmark::AddCustomContext("gpu", espdiff::cuda_status().description);
    }
#endif
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("cpu_model", cpu_model());
  benchmark::AddCustomContext("espdiff_version", espdiff::kVersion);
  add_peaks();
  register_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
