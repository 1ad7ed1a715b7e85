// pairs.cpp: compares the real pairs and prints the quality of each mapping next to the prototype's figures.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "compare/compare.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "mapping/input.h"
#include "options/options.h"
#include "options/settings.h"
#include "pair_row.h"
#include "real_pairs.h"

namespace {

using namespace espdiff_bench;

struct Settings {
  std::vector<std::pair<std::string, std::string>> given;  // options of the comparison, by name
  std::string csv, device = "cpu";
  std::vector<std::string> only;
  int threads = 0, repeats = 1;
  bool all_ubiquitin = false, all_adk = false, skip_series = false;
};

/// Adds every setting of a comparison as an option, switches as 0 or 1.
void define_options(CLI::App& app, Settings& s) {
  for (const espdiff::Setting& setting : espdiff::settings()) {
    app.add_option_function<std::string>(
           "--" + setting.name, [&s, &setting](const std::string& text) { s.given.emplace_back(setting.name, text); },
           setting.help)
        ->default_str(setting.get(espdiff::CompareOptions{}))
        ->group(setting.group);
  }
  app.add_option("--threads", s.threads, "CPU threads; 0 uses all")->capture_default_str();
  app.add_option("--device", s.device, "cpu, cuda, or cuda:N")->capture_default_str();
  app.add_option("--repeats", s.repeats, "Times are medians of this many runs")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--only", s.only, "Only pairs whose name contains one of these texts");
  app.add_flag("--skip-series", s.skip_series, "Leave out the 32 pairs of the ubiquitin series");
  app.add_flag("--all-ubiquitin", s.all_ubiquitin, "All 342 ordered pairs of the ubiquitin series instead of 32");
  app.add_flag("--all-adk", s.all_adk, "Adenylate kinase's first frame with all others too");
  app.add_option("--csv", s.csv, "Write one line a pair to this file");
}

/// Compares one pair repeatedly; times are medians, all other values are the same in every run.
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

/// Prints the rows of a group and their summary.
void print_group(const std::string& group, const std::vector<PairRow>& rows) {
  PairRow middle = summarize(rows, Summary::kMedian), extreme = summarize(rows, Summary::kWorst);
  middle.name = group + ", median of " + std::to_string(rows.size());
  extreme.name = group + ", worst";
  if (group == "series19") std::tie(middle.prototype, extreme.prototype) = series19_prototype();
  print_row(middle);
  print_row(extreme);
}

int run(const Settings& settings) {
  const espdiff::CompareOptions options = espdiff::make_options(settings.given);
  const auto engine = espdiff::select_engine(espdiff::parse_device(settings.device), settings.threads);
  std::ofstream csv;
  if (!settings.csv.empty()) {
    csv.open(settings.csv);
    if (!csv) throw espdiff::IoError(settings.csv, "cannot be written");
    csv << csv_header() << '\n';
  }
  for (const auto& [name, text] : settings.given) std::printf("%s %s, ", name.c_str(), text.c_str());
  std::printf("%d threads, times: median of %d\n", engine->n_threads(), settings.repeats);
  print_heading();
  std::map<std::string, std::vector<PairRow>> groups;
  int n_failed = 0;
  for (const RealPair& pair : real_pairs({settings.all_ubiquitin, settings.all_adk})) {
    const bool wanted = settings.only.empty() ||
                        std::any_of(settings.only.begin(), settings.only.end(),
                                    [&](const std::string& text) { return pair.name.find(text) != std::string::npos; });
    if (!wanted || (settings.skip_series && !pair.group.empty())) continue;
    const std::string missing = missing_file(pair);
    if (!missing.empty()) {
      std::printf("SKIPPED %s: there is no %s\n", pair.name.c_str(), missing.c_str());
      continue;
    }
    try {
      const PairRow row = measure(*engine, pair, options, settings.repeats);
      if (csv.is_open()) csv << csv_line(row, to_string(options.field), engine->n_threads()) << std::endl;
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
  CLI::App app("Compares the real pairs and prints the quality of the mapping next to the prototype's figures.");
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
