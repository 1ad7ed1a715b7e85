// inputs.cpp: from names and texts to options, and from states to what is compared.
#include "inputs.h"

#include <algorithm>

#include "engine/engine.h"
#include "options/settings.h"

namespace espdiff::python {
namespace {

bool is_of_potential(const std::string& name) {
  const auto& all = potential_settings();
  return std::any_of(all.begin(), all.end(), [&](const PotentialSetting& s) { return s.name == name; });
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

Computation::Computation(const Settings& given) {
  for (const auto& [name, text] : given) {
    if (set_row(computing_settings(), computing, name, text)) continue;
    if (set_row(potential_request_settings(), potential, name, text)) continue;
    (is_of_potential(name) ? potential.given : settings).emplace_back(name, text);
  }
  options = make_options(settings);
}

std::unique_ptr<Engine> Computation::make_engine() const { return select_engine(computing); }

StatesRequest Computation::states() const { return {options, potential, false, true}; }

ComparedState loaded_alone(const StatePtr& state, const Computation& computation, const Progress& progress) {
  return StateReader(computation.states(), {state}, progress).read(StateRole::kOnly);
}

}  // namespace espdiff::python
