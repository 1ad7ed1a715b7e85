// trajectory.cpp: `espdiff trajectory SOURCE FRAMES... -o OUT.csv`.
#include "trajectory/trajectory.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <utility>

#include "base/formatted.h"
#include "base/text/printable.h"
#include "cli/plot_pair.h"
#include "cli/trajectory_sides.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "frames/frame_range.h"
#include "io/files/check_outputs.h"
#include "io/frames/molfile_plugins.h"
#include "options/input_settings.h"
#include "options/options.h"
#include "plot/gnuplot.h"
#include "prepare/input_files.h"
#include "trajectory/trajectory_settings.h"

namespace espdiff::cli {
namespace {

void add_run_options(CLI::App& p, TrajectoryArguments& a) {
  const char* const group = "Frames";
  add_rows(p, trajectory_settings(), a.request);
  p.add_option("--reference", a.reference, "Compare each frame with SOURCE, or with the frame before it")
      ->check(CLI::IsMember({"source", "previous"}))
      ->capture_default_str()
      ->group(group);
  p.add_option("--source-frames", a.source_frames,
               "Frames of SOURCE, in files as FRAMES: frame i is compared with frame i of these (trajectory against "
               "trajectory)")
      ->group(group);
  p.add_option("--frames-of", a.frames_of,
               "Structure or topology whose atoms, charges and radii FRAMES have, where they are not SOURCE's")
      ->group(group);
  add_plugins_option(p, a.plugins, group);
  p.add_option("--source-model", a.source_model,
               "Model of a multi-model source file, from 1; with a topology as SOURCE, frame of the first trajectory")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group("Molecules");
}

/// A map in the Tcl command's words; empty for none.
std::string map_words(const MapArguments& m, const std::string& path, const std::string& unit) {
  if (path.empty()) return {};
  return "file " + path + (unit.empty() ? "" : " unit " + unit) + (m.map_array.empty() ? "" : " array " + m.map_array);
}

/// "file a.pqr"
std::string reference_words(const TrajectoryArguments& a) {
  const Reference reference = reference_of(a);
  if (reference == Reference::kPrevious) return "previous";
  std::string words = "file " + a.source;
  if (reference == Reference::kSame) {
    for (const std::string& path : a.source_frames) words += " " + path;
    return words + " frame same";
  }
  if (needs_molfile_reader(a.source)) words += " coordinates " + a.targets.front();
  return a.source_model == 1 ? words : words + " model " + std::to_string(a.source_model);
}

/// @param potential the computed potential in words; empty for none
SeriesDescription description_of(const TrajectoryArguments& a, const TrajectoryPlan& plan,
                                 const std::string& potential) {
  SeriesDescription run;
  run.files = a.targets;
  run.structure = a.structure;
  run.frames_of = a.frames_of;
  run.reference = plan.reference;
  run.reference_files = a.source_frames;
  if (!potential.empty()) {
    run.map = potential;
  } else {
    run.map = map_words(a.maps, a.maps.target_map, a.maps.target_map_unit);
    run.reference_map = map_words(a.maps, a.maps.source_map, a.maps.source_map_unit);
  }
  return run;
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
  if (a.reference == "previous" && !(a.source_frames.empty() && a.frames_of.empty()))
    throw InputError(std::string(a.source_frames.empty() ? "--frames-of" : "--source-frames") +
                     " and --reference previous exclude each other" +
                     (a.source_frames.empty() ? "; give the frames' own structure as SOURCE" : ""));
  TrajectoryPlan plan;
  plan.options = make_options(a.settings);
  check_request(a.request, plan.options);
  std::vector<std::string> inputs = input_files(plan.options.input);
  inputs.insert(inputs.end(), a.targets.begin(), a.targets.end());
  inputs.insert(inputs.end(), a.source_frames.begin(), a.source_frames.end());
  inputs.insert(inputs.end(), {a.source, a.frames_of, a.maps.source_map, a.maps.target_map});
  check_outputs(inputs, {a.output, a.output + ".state", a.request.residues, a.picture});
  if (!a.picture.empty()) {
    require_gnuplot();
    if (!a.request.overwrite && !a.request.resume) check_outputs({}, {a.picture}, false);
  }
  const auto begun = std::chrono::steady_clock::now();
  context.progress->report("read", 0.0);
  TrajectorySides sides(a, plan.options, *context.progress);
  plan.against = reference_of(a);
  plan.reference = reference_words(a);
  plan.frames = parse_frames(a.request.frames, sides.frames());
  plan.compared = parts_and_fields(plan.options);
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  const auto run = begin_trajectory(a.request, a.output, plan, description_of(a, plan, sides.potential()));
  if (!run->warning().empty()) std::fprintf(stderr, "espdiff: %s\n", printable(run->warning()).c_str());
  run->note_inputs(sides.inputs());
  while (!run->is_done())
    run->step(
        *engine, [&] { return sides.step(run->next()); }, *context.progress);
  const TrajectorySummary summary = run->summary();
  if (!a.picture.empty()) plot_frames(a.output, a.picture);
  if (a.quiet) return 0;
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::cout << formatted("frames         %zu\n", summary.n_frames);
  std::cout << formatted("rows           %zu written, %zu were there\n", summary.n_rows, summary.n_resumed);
  if (summary.n_skipped > 0)
    std::cout << formatted("errors         %zu rows have one instead of numbers\n", summary.n_skipped);
  std::cout << formatted("trustworthy    %zu of %zu rows%s\n", summary.n_trusted, summary.n_frames,
                         summary.n_trusted < summary.n_frames ? "; column reasons says why the others are not" : "");
  std::cout << formatted("time           %.1f s\n", s);
  if (!a.picture.empty()) std::cout << "written        " << a.output << ", " << a.picture << '\n';
  return 0;
}

}  // namespace

Verb add_trajectory(CLI::App& app) {
  auto a = std::make_shared<TrajectoryArguments>();
  CLI::App* parser = app.add_subcommand("trajectory", "Compare each frame with one structure, a row for each");
  parser->footer(
      "Frames are the models of the given files, numbered from 0 through all of them, or the frames of trajectories\n"
      "that VMD reads (DCD, XTC, TRR, NetCDF, ...), with all atoms of SOURCE in its order. With a topology (PSF,\n"
      "prmtop, GRO, ...) as SOURCE, the others are compared with the first frame. Frames without charges and radii\n"
      "(PDB, mmCIF) take those of a PQR source, whose atoms must be theirs, one to one. The source's surface and\n"
      "potential are computed once. An interrupted run can be resumed; OUT.csv.state holds its last mapping "
      "meanwhile.\n"
      "The columns are explained in docs/tcl.md, Trajectories.");
  parser
      ->add_option("SOURCE", a->source, "Structure that each frame is compared with: PQR, PDB or mmCIF; or a topology")
      ->required();
  parser->add_option("FRAMES", a->targets, "Structure files whose models are the frames, or trajectories")->required();
  parser
      ->add_option("-o,--output,--csv", a->output,
                   "CSV file that gets a row for each frame; OUT.png or OUT.svg "
                   "draws the plot, too, beside OUT.csv")
      ->required();
  add_run_options(*parser, *a);
  add_map_options(*parser, a->maps);
  add_structure_options(*parser, a->structure);
  add_settings(*parser, a->settings, SettingsFor::kPair);
  add_device_options(*parser, a->device);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser, {"--output --frames --resume --overwrite --select --potential --region --patch --offset --align "
                     "--domains --plugins --threads --quiet",
                     {"espdiff trajectory closed.pqr frames.pdb -o motion.csv",
                      "espdiff trajectory adk.psf adk.dcd --potential pb --frames 0:10:end -o motion.csv --resume"}});
  return {parser, [a](const Context& context) {
            if (is_plot(a->output)) {
              a->picture = a->output;
              a->output.replace(a->output.size() - kPlotEnding, kPlotEnding, ".csv");
            }
            return trajectory_verb(*a, context);
          }};
}

}  // namespace espdiff::cli
