// prepare.cpp: `espdiff prepare IN`.
#include <iostream>
#include <nlohmann/json.hpp>

#include "align/compared_chains.h"
#include "base/formatted.h"
#include "base/version.h"
#include "cli/options.h"
#include "cli/output_prefix.h"
#include "cli/verbs.h"
#include "cli/words/help.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/molecules/write_pqr.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "report/sections/preparation_json.h"

namespace espdiff::cli {
namespace {

struct PrepareArguments {
  std::string input, output, json;
  bool quiet = false, overwrite = false;
  StructureOptions structure;
  GivenSettings settings;
};

/// OUT.pqr -> OUT.json
std::string json_beside(const std::string& output) {
  const std::size_t dot = output.rfind(".pqr");
  return (dot != std::string::npos && dot + 4 == output.size() ? output.substr(0, dot) : output) + ".json";
}

nlohmann::ordered_json as_json(const PrepareArguments& a, const Context& context, const StructureFile& file,
                               const LoadedState& state) {
  nlohmann::ordered_json json;
  json["input"] = {{"path", a.input}, {"sha256", file.sha256()}, {"model", a.structure.model}};
  json["n_atoms_left_out"] = state.n_left_out;
  json["n_bonds_across_cell"] = state.n_border_bonds;
  json["preparation"] = state.preparation ? preparation_json(*state.preparation) : nlohmann::ordered_json(nullptr);
  json["copies"] = repeated_chains(state.molecule);
  json["command_line"] = context.command_line;
  json["version"] = kVersion;
  return json;
}

void print_summary(const PrepareArguments& a, const LoadedState& state) {
  print_preparation(std::cout, state);
  if (!state.preparation) {
    double charge = 0;
    for (const float q : state.molecule.charges) charge += static_cast<double>(q);
    std::cout << formatted("charges         of the file%s\nnet charge      %.4f e\n",
                           state.charge_files.empty() ? "" : (" " + state.charge_files.front().path).c_str(), charge);
  }
  for (const auto& group : repeated_chains(state.molecule)) {
    std::string names;
    for (const std::string& name : group) names += (names.empty() ? "" : ", ") + name;
    std::cout << "copies          chains " << names << " repeat one sequence; --select //" << group.front()
              << " takes one\n";
  }
  std::cout << "written         " << a.output << ", " << a.json << '\n';
}

int prepare_verb(PrepareArguments& a, const Context& context) {
  const CompareOptions options = make_options(a.settings);
  if (a.output.empty()) a.output = output_file(a.input, ".pqr");
  if (a.json.empty()) a.json = json_beside(a.output);
  std::vector<std::string> inputs = input_files(options.input);
  inputs.push_back(a.input);
  check_outputs(inputs, {a.output, a.json}, a.overwrite);
  AtomicFile pqr(a.output), json(a.json);
  const StructureFile file(a.input);
  const LoadedState state =
      load_state(file, {a.structure, StateRole::kOnly, true, true, nullptr}, options.input, *context.progress);
  check_left_out(options.input, {&state});
  write_pqr(pqr.stream(), state.molecule);
  json.stream() << as_json(a, context, file, state).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                << '\n';
  context.progress->report("write", 1.0);
  commit_all({&pqr, &json});
  if (!a.quiet) print_summary(a, state);
  return 0;
}

}  // namespace

Verb add_prepare(CLI::App& app) {
  auto a = std::make_shared<PrepareArguments>();
  CLI::App* parser = app.add_subcommand("prepare", "Add hydrogens, charges and radii to a structure");
  parser->footer(
      "Runs PDB2PQR (Debian: pdb2pqr) with PROPKA, and Open Babel (Debian: openbabel) for ligands. The verbs that "
      "compare do the same for structures without charges.\n\n"
      "Writes OUT.pqr, and OUT.json with what was added, repaired and protonated.");
  parser->add_option("IN", a->input, "Structure: " + structure_format_names())->required();
  parser->add_option("-o,--output", a->output, "PQR file to write; IN.pqr in the working folder");
  parser->add_option("--json", a->json, "File for what was done; default: the PQR's name with .json");
  add_model_option(*parser, a->structure);
  add_structure_options(*parser, a->structure);
  add_settings(*parser, a->settings, SettingsFor::kPreparation);
  add_overwrite(*parser, a->overwrite);
  parser->add_flag("-q,--quiet", a->quiet, "Print nothing");
  set_help(*parser, {"",
                     {"espdiff prepare 1ake.pdb --select '//A;polymer' -o 1ake_a.pqr",
                      "espdiff prepare complex.pdb --ligand drug.mol2 --ph 6.5 -o complex.pqr"}});
  return {parser, [a](const Context& context) { return prepare_verb(*a, context); }};
}

}  // namespace espdiff::cli
