// trajectory.cpp: `espdiff trajectory SOURCE FRAMES... -o OUT.csv`.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <utility>

#include "base/formatted.h"
#include "base/text/printable.h"
#include "cli/commands/plot.h"
#include "cli/map_options.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "io/files/check_outputs.h"
#include "io/structures/structure_file.h"
#include "plot/gnuplot.h"
#include "study/trajectory_study.h"

namespace espdiff::cli {
namespace {

/// What `espdiff trajectory` was called with.
struct TrajectoryArguments {
  TrajectoryStudy study;
  bool quiet = false;
  MapArguments maps;
  ComputingOptions computing;
  GivenSettings settings;
};

void add_run_options(CLI::App& p, TrajectoryArguments& a) {
  add_rows(p, trajectory_settings(), a.study.request);
  add_rows(p, trajectory_file_settings(), a.study);
  p.add_option("--source-frames", a.study.source_frames,
               "Frames of SOURCE, in files as FRAMES: frame i is compared with frame i of these (trajectory against "
               "trajectory)")
      ->group("Frames");
}

constexpr std::size_t kPlotEnding = 4;

/// OUT.png or OUT.svg
bool is_plot(const std::string& path) {
  if (path.size() <= kPlotEnding) return false;
  const std::string ending = path.substr(path.size() - kPlotEnding);
  return ending == ".png" || ending == ".svg";
}

int trajectory_verb(const TrajectoryArguments& a, const Context& context) {
  check_map_options(a.maps);
  TrajectoryStudy study = a.study;
  study.maps = a.maps;
  study.potential = a.maps;
  study.options = make_options(a.settings);
  study.tell = [](const std::string& warning) { std::fprintf(stderr, "espdiff: %s\n", printable(warning).c_str()); };
  check_study(study);
  const std::string& table = study.request.csv;
  if (!study.picture.empty()) {
    require_gnuplot();
    if (!study.request.overwrite && !study.request.resume) check_outputs({}, {study.picture}, false);
  }
  const auto begun = std::chrono::steady_clock::now();
  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  const TrajectorySummary summary = run_trajectory(study, *engine, *context.progress);
  if (!study.picture.empty()) plot_frames(table, study.picture);
  if (a.quiet) return 0;
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::cout << formatted("frames         %zu\n", summary.n_frames);
  std::cout << formatted("rows           %zu written, %zu were there\n", summary.n_rows, summary.n_resumed);
  if (summary.n_skipped > 0)
    std::cout << formatted("errors         %zu rows have one instead of numbers\n", summary.n_skipped);
  std::cout << formatted("trustworthy    %zu of %zu rows%s\n", summary.n_trusted, summary.n_frames,
                         summary.n_trusted < summary.n_frames ? "; column reasons says why the others are not" : "");
  std::cout << formatted("time           %.1f s\n", s);
  if (!study.picture.empty()) std::cout << "written        " << table << ", " << study.picture << '\n';
  return 0;
}

}  // namespace

Verb add_trajectory(CLI::App& app) {
  auto a = std::make_shared<TrajectoryArguments>();
  CLI::App* parser = app.add_subcommand("trajectory", "Compare each frame with one structure, a row for each");
  parser->footer(
      "Frames are the models of the given files, numbered from 0 through all of them, or the frames of trajectories\n"
      "(Amber's NetCDF and restarts; what VMD reads: DCD, XTC, TRR, ...), with all atoms of SOURCE in its order. With\n"
      "a topology (PSF, prmtop, ...) as SOURCE, the others are compared with the first frame, which may be a PDB.\n"
      "Frames without charges and radii (PDB, mmCIF, GRO) take those of a PQR source, whose atoms must be theirs, one\n"
      "to one. The source's surface and potential are computed once. An interrupted run can be resumed; OUT.csv.state\n"
      "holds its last mapping meanwhile.\n"
      "The columns are explained in docs/tcl.md, Trajectories.");
  parser
      ->add_option("SOURCE", a->study.source,
                   "Structure that each frame is compared with: " + structure_format_names() + "; or a topology")
      ->required();
  parser->add_option("FRAMES", a->study.frames, "Structure files whose models are the frames, or trajectories")
      ->required();
  parser
      ->add_option("-o,--output,--csv", a->study.request.csv,
                   "CSV file that gets a row for each frame, OUT or OUT.csv; OUT.png or OUT.svg "
                   "draws the plot, too, beside OUT.csv")
      ->required();
  add_run_options(*parser, *a);
  add_map_options(*parser, a->maps);
  add_structure_options(*parser, a->study.structure);
  add_settings(*parser, a->settings, SettingsFor::kPair);
  add_rows(*parser, computing_settings(), a->computing);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser, {"--output --frames --resume --overwrite --select --potential --region --patch --offset --align "
                     "--domains --plugins --threads --quiet",
                     {"espdiff trajectory closed.pqr frames.pdb -o motion.csv",
                      "espdiff trajectory adk.psf adk.dcd --potential pb --frames 0:10:end -o motion.csv --resume"}});
  return {parser, [a](const Context& context) {
            std::string& table = a->study.request.csv;
            if (is_plot(table)) {
              a->study.picture = table;
              table.replace(table.size() - kPlotEnding, kPlotEnding, ".csv");
            } else if (std::filesystem::path(table).extension().empty()) {
              table += ".csv";  // `report` and `plot` find it by this name
            }
            return trajectory_verb(*a, context);
          }};
}

}  // namespace espdiff::cli
