// ensemble.cpp: `espdiff ensemble --group NAME FILE... -o OUT`.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>

#include "base/error.h"
#include "base/printable.h"
#include "cli/ensemble_inputs.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/engine.h"
#include "ensemble/ensemble_file.h"
#include "ensemble/ensemble_result.h"
#include "ensemble/ensemble_run.h"
#include "ensemble/write_ensemble.h"
#include "io/check_outputs.h"
#include "io/select_atoms.h"
#include "matrix/matrix_run.h"

namespace espdiff::cli {
namespace {

struct Arguments {
  EnsembleInputArguments inputs;
  EnsembleRun run;
  EnsembleOptions statistics;
  std::vector<std::string> patches;  ///< NAME=SELECTION
  bool check_template = false, states = false;
  std::string from, shard = "1/1", on_error = "stop", equilibration = "none", control = "tfce";
  bool quiet = false;
  DeviceArguments device;
  GivenSettings settings;
};

/// Atoms move by 0.7 A a step instead of 0.35 unless the user says otherwise. Between NMR models of ubiquitin that
/// changes potentials by 0.0015 kT/e on average, where frames differ by 0.45, and saves a quarter of the time.
CompareOptions options_of(const GivenSettings& given) {
  CompareOptions options = make_options(given);
  const bool has_step =
      std::any_of(given.begin(), given.end(), [](const auto& setting) { return setting.first == "max-step"; });
  if (!has_step) options.morph.max_step_A = 0.7;
  return options;
}

std::pair<std::string, std::string> name_and_selection(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
    throw InputError("--patch " + text + " is not NAME=SELECTION, such as site=//A/8-12");
  return {text.substr(0, sign), text.substr(sign + 1)};
}

/// The residues of each patch on the template.
std::vector<FixedPatch> fixed_patches(const Arguments& a, const Molecule& molecule) {
  std::vector<FixedPatch> patches;
  for (const std::string& text : a.patches) {
    const auto [name, selection] = name_and_selection(text);
    FixedPatch patch{name, std::vector<char>(molecule.residues.size(), 0)};
    const std::vector<bool> selected = select_some_atoms(molecule, selection, "patch");
    for (std::size_t i = 0; i < selected.size(); ++i) {
      if (selected[i]) patch.residues[static_cast<std::size_t>(molecule.atoms[i].residue)] = 1;
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

/// The statistics of a complete file.
/// @param more adds to the result
void finish(const Arguments& a, const EnsembleFile& file, const Context& context,
            const std::function<void(EnsembleResult&)>& more = {}) {
  context.progress->report("statistics", 1.0);
  EnsembleResult result = analyse_ensemble(file, a.statistics);
  if (more) more(result);
  if (a.states) result.states = compare_states(file, result);
  std::vector<std::string> written = write_ensemble(a.run.output, file, result);
  if (result.states) {
    const std::vector<std::string> tables = write_states(a.run.output, file, *result.states);
    written.insert(written.end(), tables.begin(), tables.end());
  }
  if (a.quiet) return;
  print_ensemble(std::cout, file, result);
  std::cout << "\nwritten:";
  for (const std::string& path : written) std::cout << ' ' << path;
  std::cout << '\n';
}

void print_run(const EnsembleReport& report, const Engine& engine) {
  const std::size_t n = report.n_frames - report.n_resumed;
  std::cout << n << " frames mapped in " << in_words(report.seconds);
  if (n > 0 && report.seconds > 0) {
    char each[32];
    std::snprintf(each, sizeof each, "%.2f", report.seconds / static_cast<double>(n));
    std::cout << ", " << each << " s a frame";
  }
  std::cout << " (" << engine.description() << ")";
  if (report.n_resumed > 0) std::cout << "; " << report.n_resumed << " were there already";
  if (report.n_damaged > 0) std::cout << "; " << report.n_damaged << " were incomplete, and computed again";
  if (report.n_skipped > 0) std::cout << "; " << report.n_skipped << " could not be mapped and have no values";
  std::cout << "\n" << report.path;
  const char* separator = ", by stage: ";
  for (const auto& [stage, ms] : report.time_ms) {
    char text[64];
    std::snprintf(text, sizeof text, "%s%s %.0f ms", separator, stage.c_str(), ms / static_cast<double>(n));
    std::cout << text;
    separator = ", ";
  }
  std::cout << "\n\n";
}

int run_from(const Arguments& a, const Context& context) {
  check_outputs({a.from}, ensemble_outputs(a.run.output, true));
  const EnsembleFile file(a.from, false);
  finish(a, file, context);
  return 0;
}

int run(Arguments& a, const Context& context) {
  a.statistics.equilibration = parse_equilibration(a.equilibration);
  a.statistics.control = a.control == "tfce" ? ErrorControl::kTfce : ErrorControl::kMaxT;
  const bool names_inputs = !a.inputs.groups.empty() || !a.inputs.list.empty();
  if (!a.from.empty()) {
    if (!a.patches.empty())
      throw InputError(
          "--patch selects atoms of the template, which --from does not read; name the groups, with --resume");
    if (names_inputs) throw InputError("--from reads mapped frames from a file; leave out --group and --list");
    return run_from(a, context);
  }
  const CompareOptions options = options_of(a.settings);
  a.run.shard = parse_shard(a.shard);
  a.run.skip_errors = a.on_error == "skip";
  context.progress->report("read", 0.0);
  EnsembleInputs inputs(a.inputs, options, *context.progress);
  if (options.input.has_region())
    throw InputError(option("region") + ": an ensemble tells residues and patches of the whole surface; leave it out");
  std::vector<std::string> outputs = ensemble_outputs(a.run.output, true);
  outputs.push_back(ensemble_path(a.run.output, a.run.shard));
  std::vector<std::string> read = input_files(a.settings);
  const std::vector<std::string> files = inputs.files();
  read.insert(read.end(), files.begin(), files.end());
  check_outputs(read, outputs);
  if (a.check_template && (inputs.plan().groups().size() < 2 || a.run.shard.count > 1))
    throw InputError("--check-template compares the answers of two groups, in one process; leave it out");
  const std::string warning = design_warning(inputs.plan());
  if (!warning.empty()) std::fprintf(stderr, "espdiff: warning: %s\n", printable(warning).c_str());
  const std::unique_ptr<Engine> engine = make_engine(a.device);
  const auto map_onto = [&](const std::string& text, const EnsembleRun& part) {
    inputs.choose_template(text, *context.progress);
    // A wrong selection is refused before the work. Patches are of the first template.
    if (part.output == a.run.output) a.statistics.fixed_patches = fixed_patches(a, *inputs.source().molecule);
    EnsemblePlan plan = inputs.plan();
    plan.device = engine->back_end();
    const EnsembleReport report = run_ensemble(
        *engine, plan, inputs.source(), options, part, [&](std::size_t frame) { return inputs.frame(frame); },
        *context.progress);
    if (!a.quiet) print_run(report, *engine);
    return report.path;
  };
  const std::string path = map_onto(a.inputs.template_text, a.run);
  if (a.run.shard.count > 1) return 0;
  const EnsembleFile file(path, false);
  finish(a, file, context, [&](EnsembleResult& result) {
    if (!a.check_template) return;
    const Molecule first = *inputs.source().molecule;
    EnsembleOptions statistics = a.statistics;
    statistics.fixed_patches.clear();
    for (const std::string& group : inputs.plan().groups()) {
      EnsembleRun part = a.run;
      part.output += ".template-" + group;
      const EnsembleFile other(map_onto("medoid:" + group, part), false);
      result.template_checks.push_back(
          check_template(file, result, other, analyse_ensemble(other, statistics), inputs.onto(first)));
    }
  });
  return 0;
}

void add_run_options(CLI::App& p, Arguments& a) {
  p.add_flag("--resume", a.run.resume, "Go on with OUT.h5 of an interrupted run; a complete one gets new statistics")
      ->group("Run");
  p.add_flag("--overwrite", a.run.overwrite, "Replace OUT.h5 if it exists")->group("Run");
  p.add_option("--on-error", a.on_error, "A frame that cannot be mapped stops the run, or has no values")
      ->check(CLI::IsMember({"stop", "skip"}))
      ->capture_default_str()
      ->group("Run");
  p.add_option("--shard", a.shard,
               "Map part I of N of the frames, I/N, into OUT.shard-I-of-N.h5; `espdiff merge` merges the parts")
      ->capture_default_str()
      ->group("Run");
}

void add_statistics_options(CLI::App& p, Arguments& a) {
  const char* const group = "Statistics";
  p.add_option("--from", a.from, "Compute the statistics of this complete OUT.h5 again; maps nothing")->group(group);
  p.add_option("--alpha", a.statistics.alpha, "Significance level; intervals have the confidence 1 - alpha")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str()
      ->group(group);
  p.add_flag("--check-template", a.check_template,
             "Map the medoid of each group onto every frame as well, and tell how much of the answer stays. Takes as "
             "long again for each group; files OUT.template-GROUP.h5")
      ->group(group);
  p.add_option("--patch", a.patches,
               "NAME=SELECTION: residues of the template, in gemmi's syntax (site=//A/8-12), whose surface is measured "
               "as a whole, with a p of its own; may be given again")
      ->group(group);
  p.add_flag("--states", a.states,
             "Compare every frame with every other one through the template (OUT.states.csv), and find the principal "
             "components of the potential: scores in OUT.components.csv, modes as component_1 to 3 in OUT.vtp")
      ->group(group);
  p.add_option("--control", a.control, "The family-wise p that patches are made of")
      ->check(CLI::IsMember({"tfce", "max-t"}))
      ->capture_default_str()
      ->group(group);
  p.add_option("--equilibration", a.equilibration,
               "Frames to cut off at the start of each replicate: none, a number, or auto, which leaves the most "
               "effective samples of RMSD and mean potential")
      ->capture_default_str()
      ->group(group);
  p.add_option("--most-missing", a.statistics.most_missing,
               "A vertex without a counterpart in a larger share of a group's frames is not tested")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str()
      ->group(group);
  p.add_option("--arrangements", a.statistics.test.most_arrangements,
               "Exchanges of labels at most; all of them where there are fewer")
      ->check(CLI::Range(20, 1000000))
      ->capture_default_str()
      ->group(group);
  p.add_option("--bootstrap", a.statistics.test.n_bootstrap, "Samples, where a group has one replicate")
      ->check(CLI::Range(99, 100000))
      ->capture_default_str()
      ->group(group);
  p.add_option("--seed", a.statistics.test.seed, "Of random numbers; results name it")
      ->capture_default_str()
      ->group(group);
}

}  // namespace

Verb add_ensemble(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* parser =
      app.add_subcommand("ensemble", "Compare two groups of simulations: where the difference is more than noise");
  parser->footer(
      "One surface, the template, is mapped onto every frame. Each replicate of a group is one sample. Writes OUT.h5 "
      "(potential of\n"
      "each frame in each vertex; HDF5), OUT.vtp (means, difference, intervals, p), OUT.residues.csv, OUT.patches.csv, "
      "OUT.json.\n"
      "docs/ensembles.md explains them. Unlike in other commands, --max-step is 0.7 unless it is given.\n\n"
      "Examples:\n"
      "  espdiff ensemble --group wild w1.pdb w2.pdb w3.pdb w4.pdb --group mutant m1.pdb m2.pdb m3.pdb m4.pdb \\\n"
      "    --charges wild=wild.pqr --charges mutant=mutant.pqr -o mutant\n"
      "  espdiff ensemble --list runs.csv -o mutant --resume\n"
      "  espdiff ensemble --list runs.csv --shard 2/8 -o part     # one of eight; then:\n"
      "  espdiff merge part.shard-*-of-8.h5 -o all && espdiff ensemble --from all.h5 -o all");
  add_ensemble_inputs(*parser, a->inputs);
  parser->add_option("-o,--output", a->run.output, "Prefix of the results")->required();
  add_run_options(*parser, *a);
  add_statistics_options(*parser, *a);
  add_settings(*parser, a->settings, SettingsFor::kVariants);
  add_device_options(*parser, a->device);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  return {parser, [a](const Context& context) { return run(*a, context); }};
}

}  // namespace espdiff::cli
