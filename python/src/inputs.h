// inputs.h: how a computation is to be made, and the two sides of it.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compare/input.h"
#include "compare/options.h"
#include "potential/choose_potential.h"
#include "potential/computed_map.h"
#include "potential/potential_settings.h"
#include "report/provenance.h"
#include "state.h"

namespace espdiff::python {

/// Names and texts of settings.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Where and how something is computed.
struct Computation {
  CompareOptions options;
  std::string potential = "auto", pme_cell = "auto";
  GivenPotentialSettings given;  ///< of the potential
  std::string device = "auto";
  int threads = 0;

  /// @param settings of comparisons and of potentials: each name belongs to one of them
  /// @throws InputError (unknown names, values)
  Computation(const Settings& settings, std::string potential, std::string pme_cell, std::string device, int threads);
  std::unique_ptr<Engine> make_engine() const;
};

/// The potentials of states that are compared with each other.
class MapPlan {
 public:
  /// @throws InputError (a state without charges where a potential was asked for; maps given and computed)
  MapPlan(const Computation& computation, const std::vector<const State*>& states);

  /// Why there is none, where that was not asked for.
  const std::string& because() const { return because_; }
  /// For results: empty where none is computed.
  std::string in_words() const { return options_ ? potential_in_words(*options_) : std::string(); }
  /// One side. @throws as ComputedMap
  CompareInput input_of(const State& state) const;
  /// As input_of(); notes what the side is made of.
  CompareInput input_of(const State& state, const std::string& role, std::vector<InputFile>& inputs) const;

 private:
  std::optional<ComputedMap> map_of(const State& state) const;

  std::optional<PotentialOptions> options_;
  bool own_cell_ = false;
  std::string because_;
};

/// What made a result.
/// @param inputs in any order; the result has the structures first, then the maps
Provenance provenance_of(const Engine& engine, const std::string& call, std::vector<InputFile> inputs);

}  // namespace espdiff::python
