// inputs.cpp: from names and texts to options, and from states to sides.
#include "inputs.h"

#include <algorithm>

#include "base/error.h"
#include "compare/settings.h"
#include "engine/engine.h"
#include "engine/select_engine.h"

namespace espdiff::python {
namespace {

bool is_of_potential(const std::string& name) {
  const auto& all = potential_settings();
  return std::any_of(all.begin(), all.end(), [&](const PotentialSetting& s) { return s.option == name; });
}

}  // namespace

Computation::Computation(const Settings& settings, std::string potential_, std::string pme_cell_, std::string device_,
                         int threads_)
    : potential(std::move(potential_)), pme_cell(std::move(pme_cell_)), device(std::move(device_)), threads(threads_) {
  parse_device(device);
  check_threads(threads);
  Settings of_comparison;
  for (const auto& setting : settings) (is_of_potential(setting.first) ? given : of_comparison).push_back(setting);
  options = make_options(of_comparison);
}

std::unique_ptr<Engine> Computation::make_engine() const { return select_engine(parse_device(device), threads); }

MapPlan::MapPlan(const Computation& computation, const std::vector<const State*>& states) {
  const bool any_map = std::any_of(states.begin(), states.end(), [](const State* s) { return s->map != nullptr; });
  if (any_map) {
    if (computation.potential != "auto" || !computation.given.empty())
      throw InputError(option("potential") + " and its options are of computed potentials, and maps were given");
    return;
  }
  std::vector<PotentialFacts> facts;
  for (const State* state : states) facts.push_back(potential_facts(state->all(), state->cell));
  const PotentialChoice choice = choose_potential(computation.potential, computation.pme_cell, facts);
  because_ = choice.because;
  own_cell_ = choice.method == PotentialMethod::kPme && choice.own_cell;
  if (!choice.method) {
    if (!computation.given.empty())
      throw InputError(option(computation.given.front().first) + " is of computed potentials, and none is computed" +
                       (because_.empty() ? "" : ": " + because_));
    return;
  }
  options_ = make_potential_options(*choice.method, computation.given, computation.options.temperature_K);
  options_->because = because_;
}

std::optional<ComputedMap> MapPlan::map_of(const State& state) const {
  if (!options_) return std::nullopt;
  if (!own_cell_) return ComputedMap(state.molecule, {std::nullopt, state.molecule.positions, false}, *options_);
  if (!state.cell) throw InputError(state.molecule.name + ": there is no cell; give one, or `pme_cell=\"box\"`");
  return ComputedMap(state.all(), {state.cell, {}, false}, *options_);
}

CompareInput MapPlan::input_of(const State& state) const {
  const std::optional<ComputedMap> map = map_of(state);
  return {&state.molecule, state.map.get(), map ? map->maker() : MapMaker()};
}

CompareInput MapPlan::input_of(const State& state, const std::string& role, std::vector<InputFile>& inputs) const {
  InputFile structure = state.input;
  structure.role = role;
  inputs.push_back(structure);
  if (state.map != nullptr) {
    InputFile map = state.map_input;
    map.role = role + "_map";
    inputs.push_back(map);
    return {&state.molecule, state.map.get()};
  }
  const std::optional<ComputedMap> map = map_of(state);
  if (map) inputs.push_back(computed_input(role + "_map", *map));
  return {&state.molecule, nullptr, map ? map->maker() : MapMaker()};
}

Provenance provenance_of(const Engine& engine, const std::string& call, std::vector<InputFile> inputs) {
  Provenance provenance;
  provenance.device = engine.back_end();
  provenance.device_description = engine.description();
  provenance.threads = engine.n_threads();
  provenance.command_line = call;
  std::stable_partition(inputs.begin(), inputs.end(),
                        [](const InputFile& input) { return input.role == "source" || input.role == "target"; });
  provenance.inputs = std::move(inputs);
  return provenance;
}

}  // namespace espdiff::python
