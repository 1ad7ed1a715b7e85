// frames.cpp: adenylate kinase's closed-to-open trajectory against its first frame, by both methods: the effect of
// continuing each mapping from the previous frame.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/handles.h"
#include "base/progress.h"
#include "certificate/result.h"
#include "compare/series.h"
#include "dcd_frames.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "mapping/input.h"
#include "options/options.h"
#include "pair_row.h"

namespace {

using namespace espdiff_bench;
using espdiff::Method;
using espdiff::StartFrom;

struct Arguments {
  std::string csv, rows, method, start, domains = "none";
  std::size_t every = 0;
  int threads = 0;
  std::string device = "cpu";
};

struct Run {
  Method method;
  StartFrom start;
  std::size_t every = 1;
  std::vector<PairRow> rows{};
  int n_from_previous = 0;
  double processor_s = 0;  ///< of all threads
};

std::string name_of(StartFrom start) { return start == StartFrom::kSource ? "source" : "previous"; }

std::string input(const std::string& name) {
  const char* const folder = std::getenv("ESPDIFF_DATA");
  return (folder != nullptr ? folder : ESPDIFF_SOURCE_DIR "/../shared/data") + ("/traj_adk/" + name);
}

void measure(espdiff::Engine& engine, const std::vector<espdiff::Molecule>& frames, const Arguments& a, Run& run) {
  espdiff::CompareOptions options;
  options.method = run.method;
  options.domains = a.domains;
  const std::clock_t begun = std::clock();
  espdiff::Series series(engine, {&frames[0], nullptr}, options);
  for (std::size_t f = run.every; f < frames.size(); f += run.every) {
    const espdiff::CompareResult result = series.step({&frames[f], nullptr}, run.start, {});
    run.rows.push_back(make_row(std::to_string(f), result));
    run.n_from_previous += result.mapping.start == StartFrom::kPrevious ? 1 : 0;
  }
  run.processor_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
}

std::vector<double> column(const Run& run, double PairRow::*value) {
  std::vector<double> values;
  for (const PairRow& row : run.rows) values.push_back(row.*value);
  return values;
}

/// The columns written: medians, and the worst of some.
std::string csv_of(const Run& run) {
  std::vector<double> totals;
  double sum = 0;
  for (const PairRow& row : run.rows) {
    totals.push_back(row.time_of("total"));
    sum += totals.back();
  }
  char text[160];
  std::snprintf(text, sizeof text, "%s,%s,%zu,%zu,%d,%.1f,%.1f,%.0f,%.0f", to_string(run.method).c_str(),
                name_of(run.start).c_str(), run.every, run.rows.size(), run.n_from_previous, sum / 1000,
                run.processor_s, median(totals),
                median(column(run, run.method == Method::kMorph ? &PairRow::steps : &PairRow::deform_iterations)));
  std::string line = text;
  const auto add = [&](double value, int digits) {
    std::snprintf(text, sizeof text, ",%.*f", digits, value);
    line += text;
  };
  const auto most = [&](double PairRow::*value) {
    const std::vector<double> values = column(run, value);
    return *std::max_element(values.begin(), values.end());
  };
  const std::vector<double> same = column(run, &PairRow::same_residue_percent);
  add(median(column(run, &PairRow::no_counterpart_source_percent)), 2);
  add(most(&PairRow::no_counterpart_source_percent), 2);
  add(median(column(run, &PairRow::no_counterpart_target_percent)), 2);
  add(most(&PairRow::no_counterpart_target_percent), 2);
  add(median(same), 1);
  add(*std::min_element(same.begin(), same.end()), 1);
  add(median(column(run, &PairRow::mean_displacement_A)), 2);
  add(median(column(run, &PairRow::mean_path_length_A)), 2);
  add(median(column(run, &PairRow::mapped_to_target_mean_A)), 4);
  add(median(column(run, &PairRow::target_to_mapped_max_A)), 2);
  add(median(column(run, &PairRow::corrupt_percent)), 2);
  add(most(&PairRow::intersecting_pairs), 0);
  add(most(&PairRow::n_vertices), 0);
  return line;
}

constexpr const char* kHeader =
    "method,start,every,frames,from_previous,total_s,processor_s,median_ms,median_steps,median_lost_source_percent,"
    "worst_lost_source_percent,median_lost_target_percent,worst_lost_target_percent,median_same_residue_percent,"
    "least_same_residue_percent,median_displacement_A,median_path_length_A,median_mapped_to_target_A,"
    "median_coverage_A,median_corrupt_percent,most_intersecting_pairs,most_vertices";

void write(const std::string& path, const std::string& text) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw espdiff::IoError(path, "cannot be written");
}

int run(const Arguments& a) {
  const auto engine = espdiff::select_engine(espdiff::parse_device(a.device), a.threads);
  const espdiff::Molecule psf = read_psf(input("adk.psf"));
  std::vector<espdiff::Molecule> frames;
  for (std::size_t f = 0; f < 98; ++f) frames.push_back(read_frame(psf, input("adk_dims.dcd"), f));
  std::string table = kHeader + std::string("\n"), rows = "start,every," + csv_header() + "\n";
  std::fputs(table.c_str(), stdout);
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    for (const std::size_t every : {std::size_t{1}, std::size_t{8}}) {
      for (const StartFrom start : {StartFrom::kSource, StartFrom::kPrevious}) {
        if ((!a.method.empty() && a.method != to_string(method)) || (!a.start.empty() && a.start != name_of(start)) ||
            (a.every != 0 && a.every != every))
          continue;
        Run done{method, start, every};
        measure(*engine, frames, a, done);
        const std::string line = csv_of(done) + "\n";
        std::fputs(line.c_str(), stdout);
        std::fflush(stdout);
        table += line;
        for (const PairRow& row : done.rows)
          rows += name_of(start) + "," + std::to_string(every) + "," +
                  csv_line(row, to_string(method), engine->n_threads()) + "\n";
      }
    }
  }
  write(a.csv, table);
  write(a.rows, rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Adenylate kinase frame by frame: mappings that start from the source, and from the previous frame.");
  Arguments a;
  app.add_option("--csv", a.csv, "Also write the table to this file");
  app.add_option("--rows", a.rows, "Write a row for each frame to this file");
  app.add_option("--method", a.method, "Only this method")->check(CLI::IsMember({"morph", "deform"}));
  app.add_option("--start", a.start, "Only this start")->check(CLI::IsMember({"source", "previous"}));
  app.add_option("--every", a.every, "Only every frame (1), or every eighth (8)")
      ->check(CLI::IsMember(std::vector<std::size_t>{1, 8}));
  app.add_option("--domains", a.domains, "Rigid domains, as espdiff compare has them")->capture_default_str();
  app.add_option("--threads", a.threads, "CPU threads; 0 uses all")->capture_default_str();
  app.add_option("--device", a.device, "cpu, cuda, or cuda:N")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(a);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "espdiff_adk_frames: %s\n", error.what());
    return 1;
  }
}
