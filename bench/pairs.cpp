// pairs.cpp: compares the real pairs and prints, row by row, what the mapping reached next to the prototype's figures.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "engine/select_engine.h"
#include "pair_row.h"
#include "pipeline/compare.h"
#include "real_pairs.h"

namespace {

using namespace espdiff_bench;

struct Settings {
  std::string method = "deform", field = "distance", interpolation = "trilinear", align = "all", rest_shape, csv, only;
  int threads = 0, repeats = 1;
  std::optional<double> tangential_gain, sigma, mu, rho, spacing, min_displacement, max_step, max_edge;
  std::optional<int> max_iterations;
  std::optional<double> gvf_weight, gvf_tolerance;
  std::optional<int> gvf_max_sweeps;
  bool all_ubiquitin = false, all_adk = false, thesis = false, round_trip = false, cavities = false,
       skip_series = false, subdivide = false;
};

void define_options(CLI::App& app, Settings& s) {
  app.add_option("--method", s.method, "How the surface is mapped: morph or deform")->capture_default_str();
  app.add_option("--field", s.field, "Field that draws the surface: density, distance, gvf or gvf2")
      ->capture_default_str();
  app.add_option("--gvf-weight", s.gvf_weight, "Smoothness of the gradient vector flow, Angstrom^2");
  app.add_option("--gvf-tolerance", s.gvf_tolerance, "Where the gradient vector flow ends");
  app.add_option("--gvf-max-sweeps", s.gvf_max_sweeps, "Sweeps of the gradient vector flow at most");
  app.add_option("--interpolation", s.interpolation, "trilinear or tricubic")->capture_default_str();
  app.add_option("--tangential-gain", s.tangential_gain, "Factor of the mapping's internal force");
  app.add_option("--sigma", s.sigma, "Step scale of the mapping");
  app.add_option("--mu", s.mu, "Weight of the mapping's external force");
  app.add_option("--rho", s.rho, "Rigidity of the mapping");
  app.add_option("--rest-shape", s.rest_shape, "What the mapping's internal force restores: source or none")
      ->check(CLI::IsMember({"source", "none"}));
  app.add_option("--min-displacement", s.min_displacement, "The mapping ends below it; grid spacings");
  app.add_flag("--thesis", s.thesis, "Start from the options of the thesis' iteration as it stands");
  app.add_option("--max-step", s.max_step, "Of the morph: farthest that an atom moves in a step, Angstrom");
  app.add_option("--max-edge", s.max_edge, "Of the morph: longer edges are halved, grid spacings");
  app.add_option("--max-iterations", s.max_iterations, "Limit of the mapping's iterations");
  app.add_option("--grid-spacing", s.spacing, "Angstrom");
  app.add_option("--align", s.align, "Atoms to superpose: all, backbone, ca or none")->capture_default_str();
  app.add_flag("--round-trip", s.round_trip, "Map there and back");
  app.add_flag("--cavities", s.cavities, "Keep closed cavities");
  app.add_flag("--subdivide", s.subdivide, "Halve the edges that deform has stretched");
  app.add_option("--threads", s.threads, "CPU threads; 0 takes all")->capture_default_str();
  app.add_option("--repeats", s.repeats, "Times are medians of so many runs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--only", s.only, "Only pairs whose name contains this text");
  app.add_flag("--skip-series", s.skip_series, "Leave out the 32 pairs of the ubiquitin series");
  app.add_flag("--all-ubiquitin", s.all_ubiquitin, "All 342 ordered pairs of the ubiquitin series instead of 32");
  app.add_flag("--all-adk", s.all_adk, "Adenylate kinase's first frame with all others too");
  app.add_option("--csv", s.csv, "Write one line a pair to this file");
}

espdiff::CompareOptions compare_options(const Settings& s) {
  espdiff::CompareOptions options = s.thesis ? espdiff::thesis_options() : espdiff::CompareOptions{};
  options.method = espdiff::parse_method(s.method);
  options.field = espdiff::parse_field_kind(s.field);
  options.align = espdiff::parse_align_atoms(s.align);
  options.deform.interpolation = options.regularize.interpolation = espdiff::parse_interpolation(s.interpolation);
  options.deform.tangential_gain = s.tangential_gain.value_or(options.deform.tangential_gain);
  options.deform.sigma = s.sigma.value_or(options.deform.sigma);
  options.deform.mu = s.mu.value_or(options.deform.mu);
  options.deform.rho = s.rho.value_or(options.deform.rho);
  options.deform.max_iterations = s.max_iterations.value_or(options.deform.max_iterations);
  options.surface.grid_spacing_A = s.spacing.value_or(options.surface.grid_spacing_A);
  options.deform_min_displacement = s.min_displacement.value_or(options.deform_min_displacement);
  options.flow.weight_A2 = s.gvf_weight.value_or(options.flow.weight_A2);
  options.flow.tolerance = s.gvf_tolerance.value_or(options.flow.tolerance);
  options.flow.max_sweeps = s.gvf_max_sweeps.value_or(options.flow.max_sweeps);
  if (!s.rest_shape.empty()) options.deform.rest_shape = s.rest_shape == "source";
  options.subdivide = s.subdivide;
  options.round_trip = s.round_trip;
  options.morph.max_step_A = s.max_step.value_or(options.morph.max_step_A);
  options.morph_max_edge = s.max_edge.value_or(options.morph_max_edge);
  if (s.cavities) options.surface.cavities = true;
  return options;
}

/// Compares one pair, as often as asked for; times are medians, all else is the same in every run.
PairRow measure(espdiff::Engine& engine, const RealPair& pair, const espdiff::CompareOptions& options, int repeats) {
  const MoleculePair molecules = pair.load();
  const espdiff::Progress silent;
  std::map<std::string, std::vector<double>> times;
  espdiff::CompareResult result;
  for (int i = 0; i < repeats; ++i) {
    result = espdiff::compare(engine, {&molecules.first, nullptr}, {&molecules.second, nullptr}, options, silent);
    for (const auto& [stage, ms] : result.time_ms) times[stage].push_back(ms);
  }
  PairRow row = make_row(pair.name, result);
  for (auto& [stage, ms] : row.time_ms) ms = median(times[stage]);
  row.prototype = pair.prototype;
  return row;
}

/// Rows of a group, as they are measured, and the ones that sum them up.
void print_group(const std::string& group, const std::vector<PairRow>& rows) {
  PairRow middle = summarize(rows, Summary::kMedian), extreme = summarize(rows, Summary::kWorst);
  middle.name = group + ", median of " + std::to_string(rows.size());
  extreme.name = group + ", worst";
  if (group == "series19") std::tie(middle.prototype, extreme.prototype) = series19_prototype();
  print_row(middle);
  print_row(extreme);
}

int run(const Settings& settings) {
  const espdiff::CompareOptions options = compare_options(settings);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, settings.threads);
  std::ofstream csv;
  if (!settings.csv.empty()) {
    csv.open(settings.csv);
    if (!csv) throw espdiff::IoError(settings.csv, "cannot be written");
    csv << csv_header() << '\n';
  }
  std::printf("%sfield %s, %s, %d threads, times: median of %d\n", settings.thesis ? "the thesis' options, " : "",
              settings.field.c_str(), settings.interpolation.c_str(), engine->n_threads(), settings.repeats);
  print_heading();
  std::map<std::string, std::vector<PairRow>> groups;
  int n_failed = 0;
  for (const RealPair& pair : real_pairs({settings.all_ubiquitin, settings.all_adk})) {
    if (pair.name.find(settings.only) == std::string::npos || (settings.skip_series && !pair.group.empty())) continue;
    const std::string missing = missing_file(pair);
    if (!missing.empty()) {
      std::printf("SKIPPED %s: there is no %s\n", pair.name.c_str(), missing.c_str());
      continue;
    }
    try {
      const PairRow row = measure(*engine, pair, options, settings.repeats);
      if (csv.is_open()) csv << csv_line(row, settings.field, engine->n_threads()) << std::endl;
      if (!pair.group.empty()) groups[pair.group].push_back(row);
      print_row(row);
    } catch (const std::exception& error) {
      std::printf("FAILED %s: %s\n", pair.name.c_str(), error.what());
      ++n_failed;
    }
    std::fflush(stdout);
  }
  for (const auto& [group, rows] : groups) print_group(group, rows);
  return n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the real pairs and prints what the mapping reached next to the prototype's figures.");
  Settings settings;
  define_options(app, settings);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pairs: %s\n", error.what());
    return 2;
  }
}
