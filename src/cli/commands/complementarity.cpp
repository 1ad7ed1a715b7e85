// complementarity.cpp: `espdiff complementarity COMPLEX [COMPLEX] --interface A:B -o OUT`.
#include <iostream>
#include <optional>

#include "base/error.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "complementarity/complementarity_report.h"
#include "engine/engine.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "report/state_report.h"

namespace espdiff::cli {
namespace {

struct ComplementarityArguments {
  std::string source, target, interface, output;
  bool quiet = false, overwrite = false;
  StructureOptions structure;
  PotentialRequest potential;
  ComputingOptions computing;
  GivenSettings settings;
};

LoadedState load_complex(const ComplementarityArguments& a, const std::string& role, const InputOptions& options,
                         Provenance& provenance, const Progress& progress) {
  const std::string& path = role == "source" ? a.source : a.target;
  const StructureFile file(path);
  const StateRequest request{a.structure, role == "source" ? StateRole::kSource : StateRole::kTarget};
  PotentialRequest potential = a.potential;
  potential.is_required = true;
  LoadedState state = load_for(potential, true, file, request, options, progress);
  for (InputFile& input : state_inputs(role, {role, path, file.sha256(), nullptr, a.structure}, state))
    provenance.inputs.push_back(std::move(input));
  return state;
}

int complementarity_verb(const ComplementarityArguments& a, const Context& context) {
  const InterfaceRequest request = parse_interface(a.interface);
  const CompareOptions options = make_options(a.settings);
  std::vector<std::string> inputs = input_files(options.input), outputs;
  inputs.insert(inputs.end(), {a.source, a.target});
  for (const std::string& ending : complementarity_endings()) outputs.push_back(a.output + ending);
  check_outputs(inputs, outputs);
  if (!a.overwrite) refuse_existing(a.output);
  for (const std::string& output : outputs) AtomicFile probe(output);  // before the work
  Provenance provenance;
  provenance.command_line = context.command_line;
  std::vector<LoadedState> states;
  states.push_back(load_complex(a, "source", options.input, provenance, *context.progress));
  if (!a.target.empty()) states.push_back(load_complex(a, "target", options.input, provenance, *context.progress));
  std::vector<PotentialFacts> facts;
  for (const LoadedState& state : states) facts.push_back(facts_of(state));
  const PotentialPlan plan(a.potential, facts, options.temperature_K);
  if (!plan.computes())
    throw InputError("complementarity needs potentials: " +
                     (plan.because().empty() ? "leave out " + option("potential", "none") : plan.because()));
  const std::unique_ptr<Engine> engine = select_engine(a.computing);
  provenance.device = engine->back_end();
  std::vector<InterfaceOfComplex> interfaces;
  for (const LoadedState& state : states)
    interfaces.emplace_back(
        *engine, state, request, [&plan](const LoadedState& charged) { return plan.map_of(charged); }, options,
        *context.progress);
  ComplementarityResult result;
  result.request = request;
  for (const InterfaceOfComplex& interface : interfaces) result.states.push_back(&interface.result());
  for (std::size_t side = 0; side < 2 && interfaces.size() > 1; ++side)
    result.changes.push_back(change_of_side(*engine, interfaces[0], interfaces[1], side, options, *context.progress));
  context.progress->report("write", 1.0);
  write_complementarity(a.output, result, provenance);
  if (!a.quiet) print_complementarity(std::cout, result);
  return 0;
}

}  // namespace

Verb add_complementarity(CLI::App& app) {
  auto a = std::make_shared<ComplementarityArguments>();
  CLI::App* parser = app.add_subcommand("complementarity", "Measure the electrostatic complementarity of an interface");
  parser->footer(
      "McCoy, Epa and Colman, J. Mol. Biol. 268, 570 (1997). Writes OUT.json, OUT.interface.csv (residues), "
      "OUT.first.vtp "
      "and\nOUT.second.vtp (each partner's surface). A structure without charges is prepared by PDB2PQR.");
  parser->add_option("COMPLEX", a->source, "Structure of the complex: " + structure_format_names())->required();
  parser->add_option("OTHER", a->target, "Structure of the same complex in another state");
  parser
      ->add_option("--interface", a->interface,
                   "Both partners with a colon between them: chains, as in H,L:A, or selections")
      ->required()
      ->type_name("A:B");
  parser->add_option("-o,--output", a->output, "Prefix of the results")->required()->type_name("OUT");
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  parser->add_flag("--overwrite", a->overwrite, "Replace a result of this name, if there is one");
  add_computed_map_options(*parser, a->potential);
  add_structure_options(*parser, a->structure);
  add_settings(*parser, a->settings, SettingsFor::kComplexes);
  add_rows(*parser, computing_settings(), a->computing);
  set_help(*parser, {"--interface --output --overwrite --potential --select --ph --threads --quiet",
                     {"espdiff complementarity 1vfb.pdb --interface A,B:C -o d13",
                      "espdiff complementarity wild.pdb mutant.pdb --interface A:B -o change"}});
  return {parser, [a](const Context& context) { return complementarity_verb(*a, context); }};
}

}  // namespace espdiff::cli
