// inputs.cpp: from names and texts to options, and from states to what is compared.
#include "inputs.h"

#include <algorithm>

#include "base/error.h"
#include "compare/settings.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structure_file.h"
#include "prepare/take_charges.h"
#include "report/state_report.h"

namespace espdiff::python {
namespace {

bool is_of_potential(const std::string& name) {
  const auto& all = potential_settings();
  return std::any_of(all.begin(), all.end(), [&](const PotentialSetting& s) { return s.option == name; });
}

LoadedState load_arrays(const State& state, StateRole role, const InputOptions& input, const Progress& progress) {
  refuse_options_of_files(
      input, role, state.molecule.name + " is a state of arrays; give it the atoms and charges that it is to have");
  LoadedState loaded = loaded_arrays(state);
  StateRequest request;
  request.role = role;
  request.may_prepare = false;
  if (!input.charges_from.empty()) charge_molecule(loaded.molecule, input, request, loaded.charge_files, progress);
  return loaded;
}

}  // namespace

LoadedState loaded_arrays(const State& state) {
  LoadedState loaded;
  loaded.molecule = state.molecule;
  if (state.everything != nullptr) loaded.everything = *state.everything;
  loaded.cell = state.cell;
  loaded.whole = state.molecule;
  return loaded;
}

Computation::Computation(const Settings& given, const std::string& potential_, const std::string& pme_cell,
                         std::string device_, int threads_)
    : potential{potential_, pme_cell, {}}, device(std::move(device_)), threads(threads_) {
  parse_device(device);
  check_threads(threads);
  for (const auto& setting : given) (is_of_potential(setting.first) ? potential.given : settings).push_back(setting);
  options = make_options(settings);
}

std::unique_ptr<Engine> Computation::make_engine() const { return select_engine(parse_device(device), threads); }

LoadedState load(const State& state, StateRole role, const Computation& computation, const Molecule* source,
                 const Progress& progress) {
  const InputOptions& input = computation.options.input;
  if (state.file == nullptr) return load_arrays(state, role, input, progress);
  StateRequest request{state.structure, role};
  request.source = source;
  return load_for(computation.potential, state.map == nullptr, *state.file, request, input, progress);
}

LoadedState load_target(const State& state, const Computation& computation, const LoadedState& source,
                        const Progress& progress) {
  const InputOptions& input = computation.options.input;
  const std::string& name = state.molecule.name;
  if (state.file != nullptr && state.map == nullptr)
    return load_frame(*state.file, state.structure, name, source.molecule, source.preparation.has_value(), input,
                      progress);
  LoadedState loaded = load(state, StateRole::kTarget, computation, &source.molecule, progress);
  if (state.map == nullptr && loaded.molecule.charges.empty() && !source.molecule.charges.empty())
    take_values(loaded.molecule, source.molecule, name);
  return loaded;
}

PotentialPlan plan_potential(const Computation& computation, const std::vector<const State*>& states,
                             const std::vector<const LoadedState*>& loaded) {
  const PotentialRequest& asked = computation.potential;
  if (std::any_of(states.begin(), states.end(), [](const State* s) { return s->map != nullptr; })) {
    if (asked.potential != "auto" || !asked.given.empty())
      throw InputError(option("potential") + " and its options are of computed potentials, and maps were given");
    return {};
  }
  std::vector<PotentialFacts> facts;
  for (const LoadedState* state : loaded) facts.push_back(facts_of(*state));
  return {asked, facts, computation.options.temperature_K};
}

CompareInput side_of(const State& state, const LoadedState& loaded, const PotentialPlan& plan, const std::string& role,
                     std::vector<InputFile>& inputs) {
  CompareInput side{&loaded.molecule, state.map.get(), nullptr, {}};
  if (state.map != nullptr) {
    inputs.push_back(state.map_input);
    inputs.back().role = role + "_map";
  } else if (plan.computes()) {
    const ComputedMap map = plan.map_of(loaded);
    inputs.push_back(computed_input(role + "_map", map));
    side.make_map = map.maker();
  }
  return side;
}

void note_inputs(const State& state, const LoadedState& loaded, const std::string& role,
                 std::vector<InputFile>& inputs) {
  InputFile input = state.input;
  input.role = role;
  const std::vector<InputFile> files = state_inputs(role, input, loaded);
  inputs.insert(inputs.end(), files.begin(), files.end());
}

Provenance provenance_of(const Engine& engine, const std::string& call, std::vector<InputFile> inputs) {
  Provenance provenance;
  provenance.device = engine.back_end();
  provenance.device_description = engine.description();
  provenance.threads = engine.n_threads();
  provenance.command_line = call;
  const auto is_map = [](const InputFile& input) { return input.role == "source_map" || input.role == "target_map"; };
  std::stable_partition(inputs.begin(), inputs.end(), [&](const InputFile& input) { return !is_map(input); });
  provenance.inputs = std::move(inputs);
  return provenance;
}

}  // namespace espdiff::python
