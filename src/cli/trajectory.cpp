// trajectory.cpp: `espdiff trajectory SOURCE FRAMES... -o OUT.csv`.
#include "trajectory/trajectory.h"
#include "engine/engine.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <utility>

#include "base/printable.h"
#include "cli/map_options.h"
#include "cli/verbs.h"
#include "compare/options.h"
#include "io/check_outputs.h"
#include "io/molfile_plugins.h"
#include "io/open_structure.h"
#include "io/structure_file.h"
#include "io/write_csv.h"
#include "prepare/load_state.h"
#include "prepare/region.h"
#include "prepare/surface_radii.h"
#include "report/state_report.h"
#include "trajectory/frame_files.h"
#include "trajectory/frame_range.h"
#include "trajectory/frame_state.h"
#include "trajectory/series_head.h"

namespace espdiff::cli {
namespace {

struct Arguments {
  std::string source, output, plugins, frames = "all", start = "auto", on_error = "stop";
  std::vector<std::string> targets;
  int source_model = 1;
  bool resume = false, overwrite = false, quiet = false;
  MapArguments maps;
  StructureOptions structure;
  DeviceArguments device;
  GivenSettings settings;
};

void add_run_options(CLI::App& p, Arguments& a) {
  const char* const group = "Frames";
  p.add_option("--frames", a.frames,
               "Frames to compare, from 0: all, a frame, begin:end or begin:step:end, or several of these with commas; "
               "a frame may also be first, last (or end), or -1 (the last)")
      ->capture_default_str()
      ->group(group);
  p.add_option(
       "--start", a.start,
       "Begin each frame's mapping at the source, or at the previous frame's where that is nearer (by the morph "
       "less than half as far, with at most 0.5 % of the source lost on the way): small steps, in less time; auto: "
       "source by --method morph, previous by deform")
      ->check(CLI::IsMember({"auto", "previous", "source"}))
      ->capture_default_str()
      ->group(group);
  p.add_flag("--resume", a.resume, "Go on where an interrupted run left the file")->group(group);
  p.add_flag("--overwrite", a.overwrite, "Replace the file if it exists")->group(group);
  p.add_option("--on-error", a.on_error, "skip writes a row with the error in its column `error`, and goes on")
      ->check(CLI::IsMember({"stop", "skip"}))
      ->capture_default_str()
      ->group(group);
  p.add_option("--plugins", a.plugins,
               "Folder of VMD's molfile plugins, which read trajectories and topologies (that of $VMDDIR, or of the "
               "`vmd` on PATH)")
      ->group(group);
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

std::string reference_words(const Arguments& a) {
  const std::string model = a.source_model == 1 ? "" : " model " + std::to_string(a.source_model);
  return "file " + a.source + (needs_molfile_reader(a.source) ? " coordinates " + a.targets.front() : "") + model;
}

/// @param potential the computed potential in words; empty for none
SeriesHead head_of(const Arguments& a, const TrajectoryPlan& plan, const std::string& potential) {
  SeriesDescription run;
  run.files = a.targets;
  run.structure = a.structure;
  run.frames = plan.frames;
  run.reference = plan.reference;
  run.start = plan.start;
  if (!potential.empty()) {
    run.map = potential;
  } else {
    run.map = map_words(a.maps, a.maps.target_map, a.maps.target_map_unit);
    run.reference_map = map_words(a.maps, a.maps.source_map, a.maps.source_map_unit);
  }
  return series_head(run, plan.options);
}

/// Source and frames, and how their molecules become a comparison's inputs.
class Sides {
 public:
  Sides(const Arguments& a, const CompareOptions& options, const Progress& progress)
      : a_(a),
        options_(options.input),
        progress_(progress),
        opener_(a.source, a.plugins, progress),
        frames_(a.targets, [this](const std::string& path) { return opener_.open(path); }) {
    load_source();
    surface_ = source_.molecule;
    region_ = region_residues(source_.molecule, source_.whole, source_.molecule, source_.whole, options_);
    set_surface_radii({&surface_}, options_.radii);
    source_map_ = given_map(a.maps, "source", inputs_);
    target_map_ = given_map(a.maps, "target", inputs_);
    if (has_given_maps(a.maps) || a.maps.potential == "none") return;
    plan_ = PotentialPlan(a.maps, {facts_of(source_)}, options.temperature_K);
    if (!plan_.computes()) return;
    computed_ = plan_.map_of(source_);
    inputs_.push_back(computed_input("source_map", *computed_));
  }

  int n_frames() const { return frames_.n_frames(); }
  const std::vector<InputFile>& inputs() const { return inputs_; }
  std::string potential() const { return plan_.in_words(); }
  CompareInput source() const {
    return {&surface_, source_map_ ? &*source_map_ : nullptr, computed_ ? computed_->maker() : MapMaker(), region_};
  }

  /// A frame, which stays until the next one is asked for.
  CompareInput frame(int number) {
    target_ = read(number);
    CompareInput input{&target_.molecule, target_map_ ? &*target_map_ : nullptr, nullptr, {}};
    if (plan_.computes()) input.make_map = plan_.map_of(target_).maker();
    set_surface_radii({&target_.molecule}, options_.radii);
    return input;
  }

 private:
  /// From its file; of a topology with the coordinates of a frame.
  void load_source() {
    const bool is_topology = opener_.needs_coordinates();
    if (is_topology && !needs_molfile_reader(a_.targets.front()))
      throw InputError(a_.source + ": is a topology without coordinates, and " + a_.targets.front() +
                       " is no trajectory; give a structure first, and the topology as " + option("topology"));
    // A trajectory that is open already is not read again.
    const auto structure = is_topology ? nullptr : open_structure(a_.source);
    const StructureFile& file = is_topology ? *frames_.file_of_frame(0).first : *structure;
    StateRequest request{a_.structure, StateRole::kSource};
    request.structure.model = a_.source_model;
    source_ = load_for(a_.maps, !has_given_maps(a_.maps), file, request, options_, progress_);
    check_left_out(options_, {&source_});
    if (!is_topology) file.require_unchanged(opener_.sha256());
    const InputFile input{"source", a_.source, is_topology ? opener_.sha256() : file.sha256()};
    inputs_ = state_inputs("source", input, source_);
    if (is_topology) inputs_.push_back({"source_coordinates", a_.targets.front(), file.sha256()});
  }

  LoadedState read(int number) {
    return load_frame_state(frames_, number, a_.structure, source_, plan_, options_, progress_);
  }

  const Arguments& a_;
  const InputOptions& options_;
  const Progress& progress_;
  TrajectoryOpener opener_;
  FrameFiles frames_;
  LoadedState target_;
  LoadedState source_;
  Molecule surface_;  // the source's, with the radii of its surface
  std::vector<std::uint8_t> region_;
  PotentialPlan plan_;
  std::optional<Grid> source_map_, target_map_;
  std::optional<ComputedMap> computed_;
  std::vector<InputFile> inputs_;
};

int run(const Arguments& a, const Context& context) {
  check_map_options(a.maps);
  if (a.resume && a.overwrite) throw InputError("--resume and --overwrite exclude each other");
  std::vector<std::string> inputs = input_files(a.settings);
  inputs.insert(inputs.end(), a.targets.begin(), a.targets.end());
  inputs.insert(inputs.end(), {a.source, a.maps.source_map, a.maps.target_map});
  check_outputs(inputs, {a.output, a.output + ".state"});
  const auto begun = std::chrono::steady_clock::now();
  TrajectoryPlan plan;
  plan.options = make_options(a.settings);
  context.progress->report("read", 0.0);
  Sides sides(a, plan.options, *context.progress);
  plan.reference = reference_words(a);
  plan.frames = parse_frames(a.frames, {sides.n_frames()});
  plan.start = parse_start(a.start, plan.options);
  plan.skip_errors = a.on_error == "skip";
  plan.has_region = plan.options.input.has_region();
  const ExistingFile existing = a.resume      ? ExistingFile::kResume
                                : a.overwrite ? ExistingFile::kReplace
                                              : ExistingFile::kRefuse;
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  TrajectoryRun run(plan, SeriesCsv(a.output, head_of(a, plan, sides.potential()), existing));
  if (!run.warning().empty()) std::fprintf(stderr, "espdiff: %s\n", printable(run.warning()).c_str());
  run.note_inputs(sides.inputs());
  while (!run.is_done())
    run.step(
        *engine,
        [&] {
          return StepInput{sides.source(), sides.frame(run.next().frame), {}};
        },
        *context.progress);
  const TrajectorySummary summary = run.summary();
  if (a.quiet) return 0;
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::printf("frames         %zu\n", summary.n_frames);
  std::printf("rows           %zu written, %zu were there\n", summary.n_rows, summary.n_resumed);
  if (summary.n_skipped > 0) std::printf("errors         %zu rows have one instead of numbers\n", summary.n_skipped);
  std::printf("time           %.1f s\n", s);
  return 0;
}

}  // namespace

Verb add_trajectory(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* parser = app.add_subcommand("trajectory", "Compare each frame with one structure, a row for each");
  parser->footer(
      "Frames are the models of the given files, numbered from 0 through all of them, or the frames of trajectories\n"
      "that VMD reads (DCD, XTC, TRR, NetCDF, ...), with all atoms of SOURCE in its order. With a topology (PSF,\n"
      "prmtop, GRO, ...) as SOURCE, the others are compared with the first frame. Frames without charges and radii\n"
      "(PDB, mmCIF) take those of a PQR source, whose atoms must be theirs, one to one. The source's surface and\n"
      "potential are computed once. An interrupted run can be resumed; OUT.csv.state holds its last mapping "
      "meanwhile.\n"
      "The columns are explained in docs/tcl.md, Trajectories.\n\n"
      "Examples:\n"
      "  espdiff trajectory closed.pqr frames.pdb -o motion.csv\n"
      "  espdiff trajectory closed.pqr frames.pdb --potential pb --frames 0:10:end -o motion.csv --resume\n"
      "  espdiff trajectory adk.psf adk.dcd --frames 0:10:end -o motion.csv");
  parser
      ->add_option("SOURCE", a->source, "Structure that each frame is compared with: PQR, PDB or mmCIF; or a topology")
      ->required();
  parser->add_option("FRAMES", a->targets, "Structure files whose models are the frames, or trajectories")->required();
  parser->add_option("-o,--output,--csv", a->output, "CSV file that gets a row for each frame")->required();
  add_run_options(*parser, *a);
  add_map_options(*parser, a->maps);
  add_structure_options(*parser, a->structure);
  add_settings(*parser, a->settings, SettingsFor::kPair);
  add_device_options(*parser, a->device);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  return {parser, [a](const Context& context) { return run(*a, context); }};
}

}  // namespace espdiff::cli
