// frames.cpp: adenylate kinase's closed-to-open trajectory against its first frame: what it brings to start each
// mapping from the frame before.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "dcd_frames.h"
#include "engine/select_engine.h"
#include "pair_row.h"
#include "pipeline/compare.h"

namespace {

using namespace espdiff_bench;

struct Run {
  std::string name;
  std::vector<PairRow> rows;
  int n_from_previous = 0;
};

std::string input(const std::string& name) {
  const char* const folder = std::getenv("ESPDIFF_DATA");
  return (folder != nullptr ? folder : ESPDIFF_SOURCE_DIR "/../shared/data") + ("/traj_adk/" + name);
}

Run measure(espdiff::Engine& engine, const std::vector<espdiff::Molecule>& frames, std::size_t step,
            espdiff::StartFrom start, const std::string& name) {
  Run run;
  run.name = name;
  espdiff::Series series(engine, {&frames[0], nullptr}, {});
  for (std::size_t f = step; f < frames.size(); f += step) {
    const espdiff::CompareResult result = series.step({&frames[f], nullptr}, start, {});
    run.rows.push_back(make_row(std::to_string(f), result));
    run.n_from_previous += result.start == espdiff::StartFrom::kPrevious ? 1 : 0;
  }
  return run;
}

std::string csv_of(const Run& run, std::size_t step) {
  std::vector<double> totals, corrupt, coverage, iterations, distance;
  double sum = 0;
  for (const PairRow& row : run.rows) {
    totals.push_back(row.time_of("total"));
    sum += totals.back();
    corrupt.push_back(row.corrupt_percent);
    coverage.push_back(row.target_to_mapped_max_A);
    iterations.push_back(row.deform_iterations);
    distance.push_back(row.mapped_to_target_mean_A);
  }
  const auto worst = [](const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); };
  char line[400];
  std::snprintf(line, sizeof line, "%s,%zu,%zu,%d,%.1f,%.0f,%.0f,%.2f,%.2f,%.2f,%.2f,%.4f", run.name.c_str(), step,
                run.rows.size(), run.n_from_previous, sum / 1000, median(totals), median(iterations), median(corrupt),
                worst(corrupt), median(coverage), worst(coverage), median(distance));
  return line;
}

int run(const std::string& csv_path, int threads) {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, threads);
  const espdiff::Molecule psf = read_psf(input("adk.psf"));
  std::vector<espdiff::Molecule> frames;
  for (std::size_t f = 0; f < 98; ++f) frames.push_back(read_frame(psf, input("adk_dims.dcd"), f));
  std::string text =
      "start,every,frames,from_previous,total_s,median_ms,median_iterations,median_corrupt_percent,"
      "worst_corrupt_percent,median_coverage_A,worst_coverage_A,median_mapped_to_target_A\n";
  for (const std::size_t step : {std::size_t{1}, std::size_t{8}}) {
    for (const auto& [start, name] :
         {std::pair{espdiff::StartFrom::kSource, "source"}, std::pair{espdiff::StartFrom::kPrevious, "previous"}})
      text += csv_of(measure(*engine, frames, step, start, name), step) + "\n";
  }
  std::fputs(text.c_str(), stdout);
  if (csv_path.empty()) return 0;
  std::ofstream csv(csv_path);
  csv << text;
  csv.close();
  if (!csv) throw espdiff::IoError(csv_path, "cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Adenylate kinase frame by frame: mappings that start from the source, and from the frame before.");
  std::string csv;
  int threads = 0;
  app.add_option("--csv", csv, "Also write the table to this file");
  app.add_option("--threads", threads, "CPU threads; 0 takes all")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(csv, threads);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_frames: %s\n", error.what());
    return 1;
  }
}
