// inputs.h: how a computation is to be made, and its states as they are compared.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/select_engine.h"
#include "options/options.h"
#include "potential/potential_plan.h"
#include "state.h"

namespace espdiff::python {

/// Names and texts of settings.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Where and how something is computed.
struct Computation {
  Settings settings;  ///< of the comparison, as they were given
  CompareOptions options;
  PotentialRequest potential;
  ComputingOptions computing;

  /// @param given of comparisons, of potentials, and of where it is computed: each name belongs to one of these tables
  /// @throws InputError (unknown names, values)
  explicit Computation(const Settings& given);
  std::unique_ptr<Engine> make_engine() const;
  /// A potential that cannot be computed is an error: NaN for every difference would look like an answer.
  StatesRequest states() const;
};

/// A state of arrays, as it is.
LoadedState loaded_arrays(const State& state);

/// One state as comparisons take it, without its map. @throws as StateReader
ComparedState loaded_alone(const StatePtr& state, const Computation& computation, const Progress& progress);

}  // namespace espdiff::python
