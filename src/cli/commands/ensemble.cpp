// ensemble.cpp: `espdiff ensemble --group NAME FILE... -o OUT`.
#include "base/error.h"
#include "cli/verbs.h"
#ifdef ESPDIFF_HAVE_HDF5
#include <cstdio>
#include <iostream>

#include "base/formatted.h"
#include "base/text/printable.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "cli/words/help.h"
#include "engine/engine.h"
#include "ensemble/ensemble_study.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_table.h"
#include "matrix/matrix_run.h"
#endif

namespace espdiff::cli {

#ifdef ESPDIFF_HAVE_HDF5
namespace {

struct EnsembleArguments {
  std::vector<std::vector<std::string>> groups;  ///< NAME FILE...
  std::string list;
  std::vector<std::string> charges;  ///< GROUP=FILE
  std::vector<std::string> maps;     ///< GROUP=PATTERN
  EnsembleStudy study;
  bool quiet = false;
  ComputingOptions computing;
  GivenSettings settings;
};

void print_run(const EnsembleReport& report, const std::string& device) {
  const std::size_t n = report.n_frames - report.n_resumed;
  std::cout << n << " frames mapped in " << in_words(report.seconds);
  if (n > 0 && report.seconds > 0) {
    std::cout << ", " << formatted("%.2f", report.seconds / static_cast<double>(n)) << " s a frame";
  }
  std::cout << " (" << device << ")";
  if (report.n_resumed > 0) std::cout << "; " << report.n_resumed << " were there already";
  if (report.n_damaged > 0) std::cout << "; " << report.n_damaged << " were incomplete, and computed again";
  if (report.n_skipped > 0) std::cout << "; " << report.n_skipped << " could not be mapped and have no values";
  std::cout << "\n" << report.path;
  const char* separator = ", by stage: ";
  for (const auto& [stage, ms] : report.time_ms) {
    std::cout << formatted("%s%s %.0f ms", separator, stage.c_str(), ms / static_cast<double>(n));
    separator = ", ";
  }
  std::cout << "\n\n";
}

/// The groups, from options or the list.
void name_inputs(const EnsembleArguments& a, EnsembleStudy& study) {
  if (!a.groups.empty() && !a.list.empty()) throw InputError("--group and --list exclude each other; leave one out");
  if (study.from.empty() && a.groups.empty() && a.list.empty())
    throw InputError("no group was given; name one or two by --group, or a --list of them");
  EnsembleRequest& inputs = study.inputs;
  if (!study.from.empty() && !a.list.empty())
    throw InputError("--list names files, and --from has mapped frames; name its replicates by --group");
  inputs.replicates = a.list.empty() ? replicates_of_groups(a.groups) : replicates_of_list(a.list, inputs.charges);
  for (const std::string& text : a.charges) {
    const std::size_t sign = text.find('=');
    inputs.charges[text.substr(0, sign)] = sign == std::string::npos ? "" : text.substr(sign + 1);
  }
  for (const std::string& text : a.maps) {
    const std::size_t sign = text.find('=');
    inputs.maps.of_group[text.substr(0, sign)] = sign == std::string::npos ? "" : text.substr(sign + 1);
  }
  study.read_files = {a.list};
}

int ensemble_verb(const EnsembleArguments& a, const Context& context) {
  EnsembleStudy study = a.study;
  study.options = ensemble_options(a.settings);
  name_inputs(a, study);
  const EnsembleAnswer answer = run_study(
      study, [&] { return select_engine(a.computing); }, *context.progress,
      [](const Message& text) { std::fprintf(stderr, "espdiff: warning: %s\n", printable(text.plain()).c_str()); });
  if (a.quiet) return 0;
  for (const EnsembleReport& report : answer.reports) print_run(report, answer.device);
  if (answer.result == nullptr) return 0;
  print_ensemble(std::cout, *answer.file, *answer.result);
  std::vector<std::string> said = answer.result->warnings;
  for (const FieldAnswer& field : answer.fields) {
    std::cout << "\n---- field " << field.name << " ----\n\n";
    print_ensemble(std::cout, *field.file, *field.result, said);
    said.insert(said.end(), field.result->warnings.begin(), field.result->warnings.end());
  }
  std::cout << "\nwritten:";
  for (const std::string& path : answer.written) std::cout << ' ' << path;
  std::cout << '\n';
  return 0;
}

void add_input_options(CLI::App& p, EnsembleArguments& a) {
  const char* const group = "Groups";
  EnsembleRequest& inputs = a.study.inputs;
  p.add_option("--group", a.groups,
               "A group: its name, then its replicates: structure files whose models are the frames (PDB, PQR, ...), "
               "or a structure or topology (PSF, prmtop, ...) and trajectories of its atoms (DCD, XTC, ...). Give it "
               "twice to compare two groups, once to describe one")
      ->type_name("NAME FILE...")
      ->group(group);
  p.add_option("--list", a.list,
               "Table of the groups instead, comma-separated: group, structure, and optionally replicate (rows of one "
               "replicate follow each other), topology (of a trajectory's atoms), charges and maps (a pattern). Paths "
               "are relative to the "
               "list")
      ->group(group);
  p.add_option("--charges", a.charges,
               "GROUP=FILE: a PQR file of the same atoms, whose charges and radii the frames of the group take. "
               "Without it, frames keep their own, or PDB2PQR makes them from the group's first frame")
      ->group(group);
  p.add_option(
       "--maps", a.maps,
       "GROUP=PATTERN: the potential of each frame, computed by another program, in the frame's coordinates (DX, "
       "VTI, cube). %d or %03d in the pattern stands for the frame's number in its replicate, from 0, "
       "{replicate} for the replicate's name. Without it, potentials are computed (--potential)")
      ->group(group);
  add_structure_options(p, inputs.structure);
  add_computed_map_options(p, inputs.potential);
}

}  // namespace

Verb add_ensemble(CLI::App& app) {
  auto a = std::make_shared<EnsembleArguments>();
  CLI::App* parser =
      app.add_subcommand("ensemble", "Compare two groups of simulations: where the difference is more than noise");
  parser->footer(
      "One surface, the template, is mapped onto every frame. Each replicate of a group is one sample. Writes OUT.h5 "
      "(potential of\n"
      "each frame in each vertex; HDF5), OUT.vtp (means, difference, intervals, p), OUT.residues.csv, OUT.patches.csv, "
      "OUT.json.\n"
      "docs/ensembles.md explains them. Unlike in other commands, --max-step is 0.7 unless it is given.");
  add_input_options(*parser, *a);
  parser->add_option("-o,--output", a->study.run.output, "Prefix of the results")->required();
  add_rows(*parser, ensemble_settings(), a->study);
  add_settings(*parser, a->settings, SettingsFor::kVariants);
  add_rows(*parser, computing_settings(), a->computing);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser,
           {"--output --group --list --charges --from --resume --overwrite --shard --frames --template "
            "--check-template --select --patch --threads --quiet",
            {"espdiff ensemble --group wild wild.psf w1.dcd w2.dcd --group mutant mutant.psf m1.dcd m2.dcd -o mutant",
             "espdiff ensemble --list runs.csv -o mutant --resume",
             "espdiff ensemble --list runs.csv --shard 2/8 -o part     # one of eight; then:",
             "espdiff merge part.shard-*-of-8.h5 -o all && espdiff ensemble --from all.h5 -o all"}});
  return {parser, [a](const Context& context) { return ensemble_verb(*a, context); }};
}

#else

Verb add_ensemble(CLI::App& app) {
  CLI::App* parser = app.add_subcommand("ensemble", "Compare two groups of simulations (not in this build)");
  parser->allow_extras();
  return {parser, [](const Context&) -> int {
            throw InputError(
                "this build has no ensembles: HDF5 was not found when it was configured (Debian: libhdf5-dev)");
          }};
}

#endif

}  // namespace espdiff::cli
