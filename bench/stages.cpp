// stages.cpp: times every stage and the whole comparison, and prints the quality of each result beside its time.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <regex>
#include <string>
#include <vector>

#include "base/progress.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"
#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"
#include "engine/surface_stage.h"
#include "io/files/atomic_file.h"
#include "machine_peak.h"
#include "mapping/input.h"
#include "mapping/map_by_morph.h"
#include "options/options.h"
#include "renumbered.h"
#include "stage_inputs.h"
#include "stage_timer.h"
#include "whole_runs.h"
#include "work_model.h"

namespace {

using espdiff::DeformOptions;
using espdiff::MeshPtr;
using espdiff_bench::Case;
using espdiff_bench::StageInputs;
using espdiff_bench::StageTimer;

const espdiff::Progress kSilent;

void count_work(StageTimer& timer, const espdiff_bench::Work& work) {
  timer.counters["work_bytes"] = work.bytes;
  timer.counters["work_operations"] = work.operations;
}

/// One benchmark; called with the inputs of a case, it times itself.
struct Stage {
  std::string name;
  std::function<void(StageTimer&, const StageInputs&)> run;
  bool slow = false;  ///< takes seconds instead of milliseconds: fewer repetitions
  bool once = false;  ///< one call is long enough to time
};

void count_mesh(StageTimer& timer, const StageInputs& in, const MeshPtr& mesh) {
  timer.counters["vertices"] = static_cast<double>(in.engine->n_vertices(mesh));
  timer.counters["triangles"] = static_cast<double>(in.engine->n_triangles(mesh));
}

void count_fit(StageTimer& timer, const espdiff::FitReport& fit) {
  timer.counters["corrupt_percent"] = 100 * fit.corrupt_area_fraction;
  timer.counters["flipped_percent"] = 100 * fit.flipped_area_fraction;
}

void density(StageTimer& timer, const StageInputs& in) {
  espdiff::GridPtr grid;
  timer.time(*in.engine, [&] { grid = in.engine->density(in.source.atoms, in.spacing()); });
  timer.counters["lattice_points"] = static_cast<double>(in.engine->download(grid).values.size());
  count_work(timer, espdiff_bench::density_work(in));
}

void upload_atoms(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine,
             [&] { in.engine->upload_atoms(in.source.molecule.positions, in.source.widths, in.source.residues); });
  timer.counters["atoms"] = static_cast<double>(in.source.molecule.size());
}

void count_surface(StageTimer& timer, const StageInputs& in) {
  count_mesh(timer, in, in.source.raw);
  timer.counters["components"] = static_cast<double>(in.n_components);
  timer.counters["closed_manifold"] = in.fault.empty() ? 1 : 0;
  if (in.marching_cubes.n_triangles == 0) return;
  timer.counters["marching_cubes_triangles"] = static_cast<double>(in.marching_cubes.n_triangles);
  timer.counters["marching_cubes_ms"] = in.marching_cubes.ms;
  timer.counters["flying_edges_ms"] = in.flying_edges.ms;
}

void isosurface(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine, [&] { in.engine->isosurface(in.source.density, in.isovalue()); });
  count_surface(timer, in);
  count_work(timer, espdiff_bench::isosurface_work(in));
}

/// From atoms to triangles, including the sorting of atoms, for comparison with a peer's surface. The bar is the peer's
/// time, scaled by our number of triangles over that of marching cubes on the same grid.
void density_and_isosurface(StageTimer& timer, const StageInputs& in, double quicksurf_ms) {
  timer.time(*in.engine, [&] {
    const auto atoms = in.engine->upload_atoms(in.source.molecule.positions, in.source.widths, in.source.residues);
    in.engine->isosurface(in.engine->density(atoms, in.spacing()), in.isovalue());
  });
  count_surface(timer, in);
  if (in.marching_cubes.n_triangles == 0) return;
  const double ratio =
      static_cast<double>(in.engine->n_triangles(in.source.raw)) / static_cast<double>(in.marching_cubes.n_triangles);
  timer.counters["triangle_ratio"] = ratio;
  if (quicksurf_ms > 0 && in.engine->n_threads() == 1) timer.counters["bar_ms"] = quicksurf_ms * ratio;
}

void components(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine, [&] { in.engine->components(in.source.raw); });
  timer.counters["components"] = static_cast<double>(in.n_components);
}

void project(StageTimer& timer, const StageInputs& in) {
  MeshPtr mesh;
  timer.time(*in.engine,
             [&] { mesh = in.engine->project(in.source.raw, in.source.atoms, in.isovalue(), in.projection_limit()); });
  count_mesh(timer, in, mesh);
  count_fit(timer, in.engine->fit(mesh, in.source.atoms, in.isovalue()));
  count_work(timer, espdiff_bench::project_work(in));
}

/// Straight paths to the displaced copy, without its regularization.
void morph(StageTimer& timer, const StageInputs& in) {
  std::vector<espdiff::MovingAtom> atoms(in.source.molecule.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    atoms[i].start = in.source.molecule.positions[i];
    atoms[i].end = in.target.molecule.positions[i];
    atoms[i].start_width = atoms[i].end_width = static_cast<double>(in.source.widths[i]);
    atoms[i].pair = static_cast<std::int32_t>(i);
  }
  espdiff::MorphResult result;
  timer.time(*in.engine, [&] {
    result = in.engine->morph(in.start, atoms, in.source.atoms, in.target.atoms, espdiff::morph_options(in.options),
                              "morph", kSilent);
  });
  count_mesh(timer, in, result.mapped);
  timer.counters["morph_steps"] = result.report.steps;
  timer.counters["mean_distance_A"] = in.engine->distances(result.mapped, in.target.surface, 1.0).mean;
  count_fit(timer, in.engine->fit(result.mapped, in.target.atoms, in.isovalue()));
  count_work(timer, espdiff_bench::morph_work(in, result.report.steps));
}

/// The molecule's potential with the usual spacing and border.
void poisson_boltzmann(StageTimer& timer, const StageInputs& in) {
  const espdiff::Molecule& m = in.source.molecule;
  const espdiff::Lattice lattice =
      espdiff::poisson_boltzmann_lattice(m.positions, m.radii, espdiff::kUsualPbSpacing_A, espdiff::kUsualPbPadding_A);
  espdiff::PoissonBoltzmannReport report;
  timer.time(*in.engine, [&] {
    in.engine->poisson_boltzmann(m.positions, m.radii, m.charges, lattice, {}, {}, nullptr, kSilent, &report);
  });
  timer.counters["lattice_points"] = static_cast<double>(lattice.n_points());
  timer.counters["cycles"] = report.cycles;
  timer.counters["surface_error"] = report.surface_error;
  count_work(timer, espdiff_bench::poisson_boltzmann_work(lattice.n_points(), report.cycles));
}

void density_field(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine, [&] { in.engine->density_field(in.target.density, in.isovalue()); });
  count_work(timer, espdiff_bench::density_field_work(in));
}

void distance_field(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine, [&] {
    in.engine->distance_field(in.target.density, in.isovalue(), in.target.surface, in.options.distance_threshold_A,
                              kSilent);
  });
}

/// Mean time per iteration over a run of many.
void per_iteration(StageTimer& timer, const StageInputs& in, const MeshPtr& mesh, const espdiff::FieldPtr& field,
                   DeformOptions options) {
  constexpr int kIterations = 50;
  options.max_iterations = kIterations;
  options.min_displacement_A = 0;
  espdiff::DeformReport report;
  timer.time(
      *in.engine, [&] { in.engine->deform(mesh, field, options, "deform", kSilent, &report); }, kIterations);
  count_mesh(timer, in, mesh);
}

void count_report(StageTimer& timer, const espdiff::DeformReport& report) {
  timer.counters["deform_iterations"] = report.iterations;
  timer.counters["converged"] = report.converged ? 1 : 0;
}

void regularize(StageTimer& timer, const StageInputs& in) {
  espdiff::DeformReport report;
  MeshPtr mesh;
  timer.time(*in.engine, [&] {
    mesh = in.engine->deform(in.source.surface, in.own_field, in.options.regularize, "regularize", kSilent, &report);
  });
  count_mesh(timer, in, mesh);
  count_report(timer, report);
  const espdiff::FitReport fit = in.engine->fit(mesh, in.source.atoms, in.isovalue());
  count_fit(timer, fit);
  timer.counters["irregularity_A"] = fit.irregularity_A;
}

void deform(StageTimer& timer, const StageInputs& in, const espdiff::FieldPtr& field) {
  espdiff::DeformReport report;
  MeshPtr mesh;
  timer.time(*in.engine,
             [&] { mesh = in.engine->deform(in.start, field, in.options.deform, "deform", kSilent, &report); });
  count_mesh(timer, in, mesh);
  count_report(timer, report);
  count_fit(timer, in.engine->fit(mesh, in.target.atoms, in.isovalue()));
  timer.counters["mean_distance_A"] = in.engine->distances(mesh, in.target.surface, 1.0).mean;
}

void fit(StageTimer& timer, const StageInputs& in) {
  espdiff::FitReport report;
  timer.time(*in.engine, [&] { report = in.engine->fit(in.mapped, in.target.atoms, in.isovalue()); });
  count_fit(timer, report);
  count_work(timer, espdiff_bench::fit_work(in));
}

/// Both directions, as in the certificate.
void distances(StageTimer& timer, const StageInputs& in) {
  espdiff::DistanceSummary there, back;
  timer.time(*in.engine, [&] {
    there = in.engine->distances(in.mapped, in.target.surface, 1.0);
    back = in.engine->distances(in.target.surface, in.mapped, 1.0);
  });
  timer.counters["mean_distance_A"] = there.mean;
  timer.counters["mean_distance_back_A"] = back.mean;
  timer.counters["max_distance_back_A"] = back.max;
  count_work(timer, espdiff_bench::distances_work(in));
}

void self_intersections(StageTimer& timer, const StageInputs& in) {
  espdiff::IntersectionReport report;
  timer.time(*in.engine, [&] { report = in.engine->self_intersections(in.mapped); });
  timer.counters["pairs"] = static_cast<double>(report.n_pairs);
}

/// Sampling and comparison of both potentials; the maps are on the device already.
void sample_and_metrics(StageTimer& timer, const StageInputs& in) {
  const auto map = in.engine->upload_map(in.map, espdiff::RigidTransform{});
  const auto corrupt = in.engine->fit(in.mapped, in.target.atoms, in.isovalue()).corrupt;
  espdiff::Metrics metrics;
  timer.time(*in.engine, [&] {
    metrics = in.engine->compare(in.start, in.mapped, in.engine->sample(map, in.start),
                                 in.engine->sample(map, in.mapped), corrupt);
  });
  timer.counters["mean_displacement_A"] = metrics.mean_displacement_A;
  timer.counters["area_A2"] = metrics.area_A2;
}

void vertex_residues(StageTimer& timer, const StageInputs& in) {
  timer.time(*in.engine, [&] { in.engine->vertex_residues(in.start, in.source.atoms); });
  count_work(timer, espdiff_bench::vertex_residues_work(in));
}

/// Everything from atoms and maps to metrics and certificate, with default options except the method.
void compare(StageTimer& timer, const StageInputs& in, espdiff::Method method) {
  espdiff::CompareResult result;
  espdiff::CompareOptions options = in.options;
  options.method = method;
  timer.time(*in.engine, [&] {
    result =
        espdiff::compare(*in.engine, {&in.source.molecule, &in.map}, {&in.target.molecule, &in.map}, options, kSilent);
  });
  const espdiff::Certificate& c = result.certificate;
  timer.counters["vertices"] = static_cast<double>(result.surface.positions.size());
  timer.counters["rmsd_A"] = result.rmsd_A;
  timer.counters["corrupt_percent"] = 100 * c.corrupt_area_fraction;
  timer.counters["flipped_percent"] = 100 * c.flipped_area_fraction;
  timer.counters["mean_distance_A"] = c.mapped_to_target.mean;
  timer.counters["mean_distance_back_A"] = c.target_to_mapped.mean;
  timer.counters["trustworthy"] = c.trustworthy ? 1 : 0;
  timer.counters["intersecting_pairs"] = static_cast<double>(c.self_intersecting_pairs);
  if (method == espdiff::Method::kDeform) timer.counters["deform_iterations"] = result.mapping.deform.iterations;
  if (method == espdiff::Method::kMorph) timer.counters["morph_steps"] = result.mapping.morph.steps;
  timer.counters["regularize_iterations"] = result.mapping.regularize.iterations;
  timer.counters["converged"] = c.converged ? 1 : 0;
  for (const auto& [stage, ms] : result.time_ms) timer.counters["ms_" + stage] = ms;
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
      {"density_and_isosurface",
       [=](StageTimer& s, const StageInputs& in) { density_and_isosurface(s, in, quicksurf_ms); }},
      {"components", components},
      {"project", project},
      {"density_field", density_field},
      {"distance_field", distance_field},
      {"regularize_iteration",
       [](StageTimer& s, const StageInputs& in) {
         per_iteration(s, in, in.source.surface, in.own_field, in.options.regularize);
         count_work(s, espdiff_bench::deform_iteration_work(in, false));
       },
       false, true},
      {"regularize", regularize, true},
      {"deform_iteration",
       [](StageTimer& s, const StageInputs& in) {
         per_iteration(s, in, in.start, in.target_distance_field, in.options.deform);
         count_work(s, espdiff_bench::deform_iteration_work(in, false));
       },
       false, true},
      {"deform_iteration_along_a_curve",
       [](StageTimer& s, const StageInputs& in) {
         const MeshPtr mesh = in.engine->upload_mesh(espdiff_bench::along_a_curve(in.engine->download(in.start)));
         per_iteration(s, in, mesh, in.target_distance_field, in.options.deform);
       },
       false, true},
      {"deform_iteration_shuffled",
       [](StageTimer& s, const StageInputs& in) {
         const MeshPtr mesh = in.engine->upload_mesh(espdiff_bench::shuffled(in.engine->download(in.start)));
         per_iteration(s, in, mesh, in.target_distance_field, in.options.deform);
       },
       false, true},
      {"deform_iteration_tricubic",
       [=](StageTimer& s, const StageInputs& in) {
         per_iteration(s, in, in.start, in.target_distance_field, tricubic(in.options.deform));
         count_work(s, espdiff_bench::deform_iteration_work(in, true));
       },
       false, true},
      {"deform_density_field", [](StageTimer& s, const StageInputs& in) { deform(s, in, in.target_density_field); },
       true},
      {"deform_distance_field", [](StageTimer& s, const StageInputs& in) { deform(s, in, in.target_distance_field); },
       true},
      {"morph", morph, true},
      {"poisson_boltzmann", poisson_boltzmann, true},
      {"fit", fit},
      {"distances", distances},
      {"self_intersections", self_intersections},
      {"sample_and_metrics", sample_and_metrics},
      {"vertex_residues", vertex_residues},
      {"compare_morph", [](StageTimer& s, const StageInputs& in) { compare(s, in, espdiff::Method::kMorph); }, true},
      {"compare_deform", [](StageTimer& s, const StageInputs& in) { compare(s, in, espdiff::Method::kDeform); }, true},
  };
}

void print(const std::string& name, const StageTimer& timer) {
  std::printf("%-50s %10.4f ms", name.c_str(), timer.median_ms());
  for (const auto& [what, value] : timer.counters) std::printf("  %s=%g", what.c_str(), value);
  std::printf("\n");
  std::fflush(stdout);
}

nlohmann::ordered_json record_of(const std::string& name, const StageTimer& timer) {
  nlohmann::ordered_json record{{"name", name}, {"real_time", timer.median_ms()}, {"time_unit", "ms"}};
  record["repetitions"] = timer.n_repetitions();
  for (const auto& [what, value] : timer.counters) record[what] = value;
  return record;
}

constexpr int kRepetitions = 5, kSlowRepetitions = 3;

/// Runs one benchmark, prints it, and adds it to the records.
void run_one(const std::string& name, StageTimer timer, const std::function<void(StageTimer&)>& run,
             nlohmann::ordered_json& records) {
  try {
    run(timer);
  } catch (const std::exception& error) {
    std::printf("%-50s SKIPPED: %s\n", name.c_str(), error.what());
    return;
  }
  print(name, timer);
  records.push_back(record_of(name, timer));
}

/// Runs the matching benchmarks case by case, so that the stages of one case share its inputs.
nlohmann::ordered_json run_stages(const std::regex& filter) {
  constexpr std::size_t kLarge = 30000;  // atoms; seconds per stage: once will do
  constexpr double kLeastMilliseconds = 50;
  nlohmann::ordered_json records = nlohmann::ordered_json::array();
  for (const Case& of : espdiff_bench::cases()) {
    for (const espdiff_bench::BenchDevice& device : espdiff_bench::devices()) {
      for (const Stage& stage : stages(of.quicksurf_ms)) {
        const std::string name = stage.name + "/" + of.name + "/" + device.name;
        if (!std::regex_search(name, filter)) continue;
        const int slow = of.n_atoms > kLarge ? 1 : kSlowRepetitions;
        run_one(
            name, {stage.slow ? slow : kRepetitions, stage.slow || stage.once ? 0 : kLeastMilliseconds},
            [&](StageTimer& timer) { stage.run(timer, espdiff_bench::stage_inputs(of, device)); }, records);
      }
    }
  }
  return records;
}

void run_wholes(const std::regex& filter, nlohmann::ordered_json& records) {
  for (const espdiff_bench::WholeRun& whole : espdiff_bench::whole_runs()) {
    for (const espdiff_bench::BenchDevice& device : espdiff_bench::devices()) {
      const std::string name = whole.name + "/" + device.name;
      if (!std::regex_search(name, filter) || (whole.slow && device.n_threads == 1)) continue;
      const auto engine = espdiff::select_engine(device.request, device.n_threads);
      run_one(
          name, {whole.slow ? 1 : kRepetitions, 0}, [&](StageTimer& timer) { whole.run(timer, *engine); }, records);
    }
  }
}

void add_peak(nlohmann::ordered_json& context, const std::string& device, const espdiff_bench::MachinePeak& peak) {
  context["bandwidth_GBps " + device] = peak.gigabytes_per_s;
  context["arithmetic_Gops " + device] = peak.gigaoperations_per_s;
}

/// The peaks for the roofline, measured in the same run.
void add_peaks(nlohmann::ordered_json& context) {
  for (const espdiff_bench::BenchDevice& device : espdiff_bench::devices()) {
    if (device.n_threads > 0) add_peak(context, device.name, espdiff_bench::cpu_peak(device.n_threads));
#if defined(ESPDIFF_HAVE_CUDA)
    if (device.n_threads == 0) {
      add_peak(context, device.name, espdiff_bench::cuda_peak());
      context["gpu"] = espdiff::cuda_status().description.plain();
    }
#endif
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the stages of a comparison and prints the quality of each result beside its time");
  std::string filter = ".", out;
  app.add_option("--filter", filter, "Regular expression for STAGE/CASE/DEVICE, such as '^deform.*/1tca/threads:1'");
  app.add_option("--out", out, "Write the results as JSON");
  CLI11_PARSE(app, argc, argv);
  try {
    nlohmann::ordered_json results;
    results["context"] = espdiff_bench::machine_context();
    add_peaks(results["context"]);
    results["benchmarks"] = run_stages(std::regex(filter));
    run_wholes(std::regex(filter), results["benchmarks"]);
    if (!out.empty()) {
      espdiff::AtomicFile file(out);
      file.stream() << results.dump(1) << "\n";
      file.commit();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_stages: %s\n", error.what());
    return 1;
  }
  return 0;
}
