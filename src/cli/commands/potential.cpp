// potential.cpp: `espdiff potential MOLECULE`.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

#include "base/formatted.h"
#include "base/molecule/water.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "frames/frame_range.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/grids/write_grid.h"
#include "io/structures/structure_file.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "potential/map_series_request.h"
#include "potential/potential_plan.h"
#include "potential/potential_series.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "report/sections/preparation_json.h"

namespace espdiff::cli {
namespace {

struct PotentialArguments {
  std::string molecule, output, variance, standard_error;
  std::string frames = "all";
  MapSeriesRequest map;
  GivenPotentialSettings given;
  bool quiet = false, overwrite = false;
  GivenSettings settings;
  StructureOptions structure{1, true, true};
  ComputingOptions computing;
};

void add_frame_options(CLI::App& p, PotentialArguments& a) {
  const char* const group = "Frames";
  p.add_option("--frames", a.frames,
               "Models of the file, from 0: all, a frame, begin:end or begin:step:end; see `espdiff trajectory`")
      ->capture_default_str()
      ->group(group);
  p.add_option("--variance", a.variance, "Also write the variance over frames, (kT/e)^2 (.dx or .vti)")->group(group);
  p.add_option("--standard-error", a.standard_error,
               "Also write the standard error of the mean, from the means of blocks of frames (.dx or .vti)")
      ->group(group);
}

/// OUT.dx -> OUT.0007.dx
std::string numbered(const std::string& path, int frame) {
  const std::size_t dot = path.rfind('.');
  return path.substr(0, dot) + formatted(".%04d", frame) + path.substr(dot);
}

/// Output files of a run: opened at the start, so that a missing folder is found before the work; renamed at the end,
/// all or none.
class Outputs {
 public:
  Outputs(const PotentialArguments& a, const std::vector<int>& frames) : each_(a.map.each) {
    std::vector<std::string> paths;
    if (!each_) paths.push_back(a.output);
    for (std::size_t i = 0; each_ && i < frames.size(); ++i) paths.push_back(numbered(a.output, frames[i]));
    n_maps_ = paths.size();
    for (const std::string* path : {&a.variance, &a.standard_error}) {
      if (!path->empty()) paths.push_back(*path);
    }
    std::vector<std::string> inputs = input_files(make_options(a.settings).input);
    inputs.insert(inputs.end(), {a.molecule, a.map.xsc_file});
    check_outputs(inputs, paths, a.overwrite);
    for (const std::string& path : paths) open(path);
  }

  void write_frame(std::size_t number, const Grid& map) { write_map(*files_[number], map); }
  void finish(const PotentialArguments& a, const Grid& mean, const RunningMap& average) {
    if (!each_) write_map(*files_[0], mean);
    std::size_t next = n_maps_;
    if (!a.variance.empty()) write_map(*files_[next++], average.variance());
    if (!a.standard_error.empty()) write_map(*files_[next++], average.standard_error());
    std::vector<AtomicFile*> all;
    for (const auto& file : files_) all.push_back(file.get());
    commit_all(all);
  }

 private:
  void open(const std::string& path) {
    check_map_ending(path);
    files_.push_back(std::make_unique<AtomicFile>(path));
  }

  bool each_;
  std::size_t n_maps_ = 0;
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

std::size_t count_waters(const Molecule& molecule) {
  return static_cast<std::size_t>(std::count_if(molecule.residues.begin(), molecule.residues.end(),
                                                [](const Residue& residue) { return is_water_name(residue.name); }));
}

void print_summary(const Molecule& molecule, const Grid& map, std::size_t n_frames, bool in_continuum, double ms) {
  double charge = 0;
  for (const float q : molecule.charges) charge += static_cast<double>(q);
  // In lanes, so that no value waits for the one before: a large map has a hundred million.
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> least{}, most{};
  const auto take = [&](std::size_t lane, float v) {
    least[lane] = v < least[lane] ? v : least[lane];
    most[lane] = v > most[lane] ? v : most[lane];
  };
  std::size_t i = 0;
  for (; i + kLanes <= map.values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, map.values[i + lane]);
  }
  for (; i < map.values.size(); ++i) take(0, map.values[i]);
  const auto& size = map.lattice.size;
  std::cout << formatted("potential      %d x %d x %d points, %.3f to %.3f kT/e\n", size[0], size[1], size[2],
                         static_cast<double>(*std::min_element(least.begin(), least.end())),
                         static_cast<double>(*std::max_element(most.begin(), most.end())));
  std::cout << formatted("charge         %.4f e in %zu atoms\n", charge, molecule.size());
  // In a dielectric continuum explicit water is solute, which few mean.
  const std::size_t n_waters = count_waters(molecule);
  if (in_continuum && n_waters > 0)
    std::cout << formatted("water          %zu molecules are part of the solute (--no-water leaves them out)\n",
                           n_waters);
  std::cout << formatted("frames         %zu\n", n_frames);
  std::cout << formatted("time           %.0f ms\n", ms);
}

/// The molecules of the frames, with charges.
class Frames {
 public:
  Frames(const PotentialArguments& a, const StructureFile& file, const Progress& progress)
      : a_(a), options_(make_options(a.settings).input), file_(file), progress_(progress) {}

  /// The first one is loaded as by `compare`, further ones like it.
  Molecule read(int frame) {
    structure_.model = frame + 1;
    if (!first_) {
      first_ = load_for({to_string(a_.map.method), "auto", {}}, true, file_, {structure_, StateRole::kOnly}, options_,
                        progress_);
      check_left_out(options_, {&*first_});
      return first_->molecule;
    }
    const std::string name = first_->molecule.name + ", frame " + std::to_string(frame);
    return load_frame(file_, structure_, name, first_->molecule, first_->preparation.has_value(), options_, progress_)
        .molecule;
  }
  /// @pre read() was called
  const LoadedState& first() const { return *first_; }

 private:
  const PotentialArguments& a_;
  const InputOptions options_;
  const StructureFile& file_;
  const Progress& progress_;
  StructureOptions structure_ = a_.structure;
  std::optional<LoadedState> first_;
};

int potential_verb(PotentialArguments& a, const Context& context) {
  if (a.output.empty()) a.output = output_file(a.molecule, ".dx");
  const PotentialOptions options = options_of(a.map, a.given, make_options(a.settings).temperature_K);
  const auto start = std::chrono::steady_clock::now();
  context.progress->report("read", 0.0);
  const StructureFile file(a.molecule);
  const std::vector<int> frames = parse_frames(a.frames, {file.n_models()});
  if (frames.size() < 2 && !(a.variance.empty() && a.standard_error.empty()))
    throw InputError("--variance and --standard-error need at least 2 frames; there is " +
                     std::to_string(frames.size()));
  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  PotentialSeries series(*engine, options);
  Outputs outputs(a, frames);
  Frames states(a, file, *context.progress);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Molecule molecule = states.read(frames[i]);
    require_charges(molecule);
    // A crystal's cell is no cell of a molecule without its water.
    const auto cell = states.first().preparation ? std::nullopt : file.unit_cell(frames[i] + 1);
    if (a.map.each) {
      outputs.write_frame(i, series.step(molecule, cell, *context.progress));
    } else {
      series.add(molecule, cell, *context.progress);
    }
    context.progress->report("frames", static_cast<double>(i + 1) / static_cast<double>(frames.size()));
  }
  context.progress->report("write", 1.0);
  const Grid mean = series.average().mean();
  outputs.finish(a, mean, series.average());
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (a.quiet) return 0;
  print_preparation(std::cout, states.first());
  print_summary(states.first().molecule, mean, frames.size(), a.map.method == PotentialMethod::kPoissonBoltzmann, ms);
  std::cout << "written        " << (a.map.each ? numbered(a.output, frames.front()) + " and so on" : a.output) << '\n';
  return 0;
}

}  // namespace

Verb add_potential(CLI::App& app) {
  auto a = std::make_shared<PotentialArguments>();
  CLI::App* parser =
      app.add_subcommand("potential", "Compute the electrostatic potential around a molecule, or its mean over frames");
  parser->footer("Options shared with PMEPot have its names and meanings.");
  parser
      ->add_option("MOLECULE", a->molecule,
                   "Structure: PQR, or PDB, mmCIF and GRO, which PDB2PQR gives charges; several models are frames")
      ->required();
  parser->add_option("-o,--output,--dxfile", a->output,
                     "Map to write: .dx (APBS, VMD, PyMOL) or .vti (ParaView); MOLECULE.dx in the working folder");
  add_rows(*parser, map_series_settings(), a->map);
  add_potential_settings(*parser, a->given, true);
  add_settings(*parser, a->settings, SettingsFor::kMap);
  add_frame_options(*parser, *a);
  add_structure_options(*parser, a->structure);
  add_rows(*parser, computing_settings(), a->computing);
  add_overwrite(*parser, a->overwrite);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser, {"--output --method --select --ph --ligand --ionic-strength --pb-spacing --align --variance "
                     "--overwrite --threads --quiet",
                     {"espdiff potential entry.pdb --select '//A;polymer' --method pb -o entry.dx",
                      "espdiff potential frames.pqr --align ca --variance variance.dx -o mean.dx"}});
  return {parser, [a](const Context& context) { return potential_verb(*a, context); }};
}

}  // namespace espdiff::cli
