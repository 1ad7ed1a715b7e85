// inputs.cpp: from names and texts to options, and from states to what is compared.
#include "inputs.h"

#include <algorithm>

#include "base/error.h"
#include "compare/settings.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/select_atoms.h"
#include "io/structure_file.h"
#include "potential/choose_potential.h"
#include "prepare/pdb2pqr.h"
#include "report/state_report.h"

namespace espdiff::python {
namespace {

bool is_of_potential(const std::string& name) {
  const auto& all = potential_settings();
  return std::any_of(all.begin(), all.end(), [&](const PotentialSetting& s) { return s.option == name; });
}

/// A state of arrays, selected and charged as a structure file is. Where charges are made, water is dropped, as of
/// files.
LoadedState load_arrays(const State& state, const StateRequest& request, bool drops_water, const InputOptions& input,
                        const Progress& progress) {
  for (const auto& [name, text] : {std::pair("assembly", &input.assembly),
                                   {"topology", &input.both.topology},
                                   {"source-topology", &input.source.topology},
                                   {"target-topology", &input.target.topology}}) {
    if (!text->empty())
      throw InputError(option(name) + " is of structures in files, and " + state.molecule.name +
                       " is a state of arrays; give it the atoms and charges that it is to have");
  }
  LoadedState loaded = loaded_arrays(state);
  if (drops_water && !has_charges(loaded.molecule)) {
    loaded.molecule = keep_kinds(loaded.molecule, {1, true, false, {}});
    loaded.everything = {};
  }
  select_and_charge(loaded, request, input, progress);
  return loaded;
}

/// As load_for() does for files.
LoadedState load_arrays_for(const PotentialRequest& asked, const State& state, StateRequest request,
                            const InputOptions& input, const Progress& progress) {
  const bool is_auto = asked.potential == "auto";
  request.wants_charges = state.map == nullptr && asked.potential != "none";
  request.may_prepare = !is_auto || !find_pdb2pqr().empty();
  try {
    return load_arrays(state, request, request.wants_charges, input, progress);
  } catch (const InputError& error) {
    if (!is_auto || !request.wants_charges) throw;
    // Was it the preparation?
    request.wants_charges = false;
    load_arrays(state, request, false, input, progress);
    throw InputError(error.message() + "; " + option("potential", "none") + " compares shapes alone");
  }
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
  StateRequest request{state.structure, role};
  request.source = source;
  if (state.file == nullptr) return load_arrays_for(computation.potential, state, request, input, progress);
  return load_for(computation.potential, state.map == nullptr, *state.file, request, input, progress);
}

LoadedState load_target(const State& state, const Computation& computation, const LoadedState& source,
                        const Progress& progress) {
  const InputOptions& input = computation.options.input;
  const std::string& name = state.molecule.name;
  if (state.file != nullptr && state.map == nullptr)
    return load_frame(*state.file, state.structure, name, source.molecule, source.preparation.has_value(), input,
                      progress);
  if (state.file != nullptr) return load(state, StateRole::kTarget, computation, &source.molecule, progress);
  const bool like_source = state.map == nullptr && has_charges(source.molecule);
  const StateRequest request{state.structure, StateRole::kTarget, false, true, &source.molecule};
  LoadedState loaded = load_arrays(state, request, like_source, input, progress);
  if (like_source) charge_frame(loaded, source.molecule, source.preparation.has_value(), request, input, progress);
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
  PotentialPlan plan(asked, facts, computation.options.temperature_K);
  // NaN for every difference would look like an answer.
  if (!plan.computes() && asked.potential != "none")
    throw InputError(plan.because() + "; " + option("potential", "none") + " compares shapes alone");
  return plan;
}

CompareInput side_of(const State& state, const LoadedState& loaded, const PotentialPlan& plan, const std::string& role,
                     std::vector<InputFile>& inputs) {
  CompareInput side{&loaded.molecule, state.map.get(), nullptr, {}};
  side.fields.given = state.given;
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

void note_preparation(const std::string& role, const LoadedState& loaded, Provenance& provenance) {
  if (!loaded.preparation) return;
  provenance.preparations.emplace_back(role, std::make_shared<Preparation>(*loaded.preparation));
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
