// compare.cpp: `espdiff compare SOURCE TARGET -o OUT`.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text/printable.h"
#include "certificate/result.h"
#include "cli/map_options.h"
#include "cli/output_prefix.h"
#include "cli/picture.h"
#include "cli/verbs.h"
#include "cli/verdict_status.h"
#include "cli/words/help.h"
#include "cli/words/next_command.h"
#include "cli/words/spelling.h"
#include "cli/words/ways_on.h"
#include "engine/engine.h"
#include "field/field_kinds.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "prepare/charges/preparation.h"
#include "prepare/input_files.h"
#include "report/compare_answer.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/residue_values.h"
#include "report/sections/provenance.h"
#include "report/write_compare.h"
#include "study/pair_study.h"

namespace espdiff::cli {
namespace {

struct CompareArguments {
  std::string source, target, output, typed_output, picture;
  MapArguments maps;
  std::string residue_pdb, residue_quantity;
  int source_model = 1, target_model = 1;
  bool quiet = false, full = false, overwrite = false, exit_zero = false, no_trials = false;
  StructureOptions structure;
  ComputingOptions computing;
  GivenSettings settings;
};

void add_input_options(CLI::App& p, CompareArguments& a) {
  p.add_option("SOURCE", a.source, "Structure of the first state: " + structure_format_names())->required();
  p.add_option("TARGET", a.target, "Structure of the second state")->required();
  p.add_option("-o,--output", a.output,
               "Prefix of the results OUT.json, OUT.vtp and OUT.residues.csv, or a folder for them; OUT.png draws a "
               "picture, too; default: the names of both structures, with a number behind them where such a result "
               "exists")
      ->type_name("OUT");
  add_map_options(p, a.maps);
  p.add_option(
       "--residue-pdb", a.residue_pdb,
       "Also write the source as a PDB file whose B factors are the residues' --residue-quantity, for coloring in "
       "any program")
      ->group("Residues");
  p.add_option("--residue-quantity", a.residue_quantity,
               "Column of the residue table (mean_abs_difference; without potentials mean_displacement_A)")
      ->group("Residues");
  using Rows = RowsOf<CompareArguments>;
  static const std::vector<Rows::Row> models{
      Rows::count(
          "source-model", "Molecules", {1}, [](auto& o) -> auto& { return o.source_model; },
          "Model of a source file with several"),
      Rows::count(
          "target-model", "Molecules", {1}, [](auto& o) -> auto& { return o.target_model; },
          "Model of a target file with several")};
  add_rows(p, models, a);
}

StatePtr state_of(const CompareArguments& a, bool is_source) {
  State state = a.maps.of(is_source);
  state.path = is_source ? a.source : a.target;
  state.structure = a.structure;
  state.structure.model = is_source ? a.source_model : a.target_model;
  return std::make_shared<const State>(std::move(state));
}

void check_files(const CompareArguments& a, const CompareOptions& options, const std::vector<KeptFile>& kept) {
  std::vector<std::string> inputs = input_files(options.input),
                           outputs = {a.output + ".json", a.output + ".vtp", a.output + ".residues.csv", a.residue_pdb,
                                      a.picture};
  inputs.insert(inputs.end(), {a.source, a.target, a.maps.source_map, a.maps.target_map});
  for (const FieldRequest& field : options.fields) {
    for (const std::string& path : files_of(field)) inputs.push_back(path);
  }
  for (const std::string& ending : further_endings(options)) outputs.push_back(a.output + ending);
  for (const KeptFile& file : kept) outputs.push_back(a.output + file.ending);
  check_outputs(inputs, outputs);
}

PairStudy study_of(const CompareArguments& a, const CompareOptions& options, const Context& context) {
  PairStudy study{state_of(a, true), state_of(a, false), options, a.maps};
  study.command_line = context.command_line;
  study.check_kept = [&](const std::vector<KeptFile>& kept) { check_files(a, options, kept); };
  return study;
}

/// The arguments of a change.
CompareArguments changed(CompareArguments a, const WayOn& way) {
  if (way.exchanges) {
    std::swap(a.source, a.target);
    std::swap(a.source_model, a.target_model);
    std::swap(a.maps.source_map, a.maps.target_map);
    std::swap(a.maps.source_map_unit, a.maps.target_map_unit);
  }
  for (const NamedOption& option : way.options)
    a.settings.emplace_back(option.name, option.is_switch ? "1" : option.value);
  a.residue_pdb.clear();
  return a;
}

double total_seconds(const CompareResult& result) {
  for (const auto& [stage, ms] : result.time_ms) {
    if (stage == "total") return ms / 1000;
  }
  return 0;
}

/// The prefix of the results of what was typed.
std::string prefix_of(const CompareArguments& a, bool overwrite) {
  return output_prefix(a.typed_output, overwrite, {a.source, a.source_model}, {a.target, a.target_model});
}

/// What was typed, with a change.
TypedWords words_of(const CompareArguments& a, const WayOn& way, const Context& context) {
  TypedWords words = with_options(context.words, way.options);
  if (!a.overwrite && prefix_of(a, false) == a.output) words = with_options(words, {{"overwrite", "", true}});
  return way.exchanges ? exchanged(words, a.source, a.target) : words;
}

/// Tries what may help until an answer can be trusted, where there is time for it, and prints the command.
void print_next(const CompareArguments& a, const PairAnswer& first, Engine& engine, const Context& context) {
  const auto begun = std::chrono::steady_clock::now();
  std::vector<std::string> given;
  for (const auto& setting : a.settings) given.push_back(setting.first);
  PreparedStates prepared;
  for (const auto& preparation : first.provenance.preparations)
    (preparation.first == "source" ? prepared.source : prepared.target) = true;
  const double once_s = total_seconds(first.result);
  std::string tried;
  std::optional<WayOn> untried;
  for (const WayOn& way : ways_on(first.result, first.source_molecule, first.target_molecule, given, prepared)) {
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (a.no_trials) break;
    if (!has_time_for(way, once_s, spent_s)) {
      if (!untried) untried = way;
      continue;
    }
    const CompareArguments other = changed(a, way);
    try {
      const CompareOptions options = make_options(other.settings);
      const PairAnswer again = run_pair(study_of(other, options, context), engine, *context.progress);
      tried += (tried.empty() ? "" : "; ") + way.what;
      if (!again.result.certificate.trustworthy) continue;
      context.progress->report("write", 1.0);
      std::cout << "\nnext: " << as_typed(words_of(a, way, context)) << "\n      tried, " << way.what << ": ";
      print_verdict_line(std::cout, again.result);
      return;
    } catch (const Cancelled&) {
      break;
    } catch (const Error&) {  // the change does not suit these states
    }
  }
  if (untried) {
    std::cout << "\nnext: " << as_typed(words_of(a, *untried, context)) << "\n      not tried, " << untried->what
              << ": it takes about " << std::lround(untried->size * once_s) << " s";
  } else if (a.picture.empty()) {
    std::cout << "\nnext: " << as_typed({"render", a.output, "-o", a.output + ".png"}) << "\n      shows where";
  } else {
    std::cout << "\nnext: " << as_typed({"render", a.output, "--color", "why", "-o", a.output + ".why.png"})
              << "\n      shows where it is not trusted, and why";
  }
  if (!tried.empty()) std::cout << "; tried without success: " << tried;
  std::cout << '\n';
}

/// What is doubtful about charges that were made, of which a verdict says nothing.
void print_doubts(const Provenance& provenance) {
  for (const auto& [role, preparation] : provenance.preparations) {
    for (const std::string& doubt : preparation->warnings)
      std::fprintf(stderr, "espdiff: of the %s, %s\n", role.c_str(), printable(doubt).c_str());
  }
}

int compare_verb(const CompareArguments& a, const Context& context) {
  check_map_options(a.maps);
  const CompareOptions options = make_options(a.settings);
  check_files(a, options, {});
  // An unwritable output is found before the work.
  for (const char* suffix : {".json", ".vtp", ".residues.csv"}) AtomicFile probe(a.output + suffix);
  for (const std::string& ending : further_endings(options)) AtomicFile probe(a.output + ending);
  if (!a.residue_pdb.empty()) AtomicFile probe(a.residue_pdb);
  if (!a.overwrite) refuse_existing(a.output, a.picture);
  if (!a.picture.empty()) require_drawing(a.picture);
  if (a.residue_pdb.empty() && !a.residue_quantity.empty())
    throw InputError("--residue-quantity needs --residue-pdb FILE");
  if (!a.residue_quantity.empty()) require_residue_quantity(a.residue_quantity, options.fields);

  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  const PairAnswer answer = run_pair(study_of(a, options, context), *engine, *context.progress);
  const CompareResult& result = answer.result;
  context.progress->report("write", 0.0);
  std::unique_ptr<AtomicFile> pdb;
  if (!a.residue_pdb.empty()) {
    pdb = std::make_unique<AtomicFile>(a.residue_pdb);
    write_residue_pdb(*pdb, answer.source_molecule, result,
                      a.residue_quantity.empty() ? usual_residue_quantity(result) : a.residue_quantity);
  }
  write_compare(a.output, answer.source_molecule, answer.target_molecule, result, options, answer.provenance,
                answer.kept, pdb.get());
  if (!a.picture.empty()) draw_result(a.output, a.picture, result.potential.compared);
  if (a.quiet) {
    print_verdict_line(std::cout, result);
    print_doubts(answer.provenance);
  } else {
    const auto record = compare_json(answer.source_molecule, answer.target_molecule, result, options, answer.provenance,
                                     spelled_option);
    if (a.full) {
      print_table(std::cout, record);
    } else {
      print_answer(std::cout, record, as_typed({"show", a.output}));
    }
    if (!result.certificate.trustworthy) print_next(a, answer, *engine, context);
  }
  return verdict_status(result, a.exit_zero);
}

}  // namespace

Verb add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* parser =
      app.add_subcommand("compare", "Compare the electrostatic surface potentials of two states of a molecule");
  parser->footer(
      "Maps each point of the source's surface to the corresponding point of the target's, compares the potentials "
      "there, and\n"
      "certifies the mapping. Without maps the potentials are computed (--potential).\n\n"
      "Writes result.json (numbers, certificate, provenance), result.vtp (mapped surface, for ParaView) and "
      "result.residues.csv,\nwith --causes result.causes.csv, with --scan result.scan.csv, with --side-chains "
      "result.side-chains.csv.\n"
      "Exit status: 0 done, 1 could not compute, 2 wrong usage or input, 3 done, and the result is NOT TRUSTWORTHY (0 "
      "with --exit-zero).\nA result that is TRUSTWORTHY ON a part of the surface is 0, unless --require asks for "
      "more.");
  add_input_options(*parser, *arguments);
  add_structure_options(*parser, arguments->structure);
  add_settings(*parser, arguments->settings, SettingsFor::kPair);
  add_rows(*parser, computing_settings(), arguments->computing);
  parser->add_flag("-q,--quiet", arguments->quiet, "Print the verdict and the main number only");
  parser->add_flag("--full", arguments->full, "Print every number and the certificate, as `espdiff show OUT` does");
  parser->add_flag("--overwrite", arguments->overwrite, "Replace a result of this name, if there is one");
  parser->add_flag("--exit-zero", arguments->exit_zero, "Exit status 0, not 3, for a result that is NOT TRUSTWORTHY");
  parser->add_flag("--no-trials", arguments->no_trials,
                   "Do not try other commands after a result that is not trusted; without it those that take seconds "
                   "are tried, and the one that helps is printed");
  set_help(*parser,
           {"--output --overwrite --select --leave-out --ph --same-protonation --region --region-within --of "
            "--potential --source-map --target-map --offset --domains --threads --full --quiet",
            {"espdiff compare 1t24.pdb 1t2e.pdb --select '//A;polymer' --region-within 5 --of '(NAD,OXQ)' -o ldh",
             "espdiff compare wild.pqr mutant.pqr --source-map wild.dx --target-map mutant.dx -o result"}});
  return {parser, [arguments](const Context& context) {
            arguments->typed_output = arguments->output;
            if (is_picture(arguments->output)) arguments->picture = arguments->output;
            arguments->output = prefix_of(*arguments, arguments->overwrite);
            return compare_verb(*arguments, context);
          }};
}

}  // namespace espdiff::cli
