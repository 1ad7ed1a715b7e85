// inputs.h: how a computation is to be made, and its states as they are compared.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compare/input.h"
#include "compare/options.h"
#include "potential/potential_plan.h"
#include "report/provenance.h"
#include "state.h"

namespace espdiff::python {

/// Names and texts of settings.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Where and how something is computed.
struct Computation {
  Settings settings;  ///< of the comparison, as they were given
  CompareOptions options;
  PotentialRequest potential;
  std::string device = "auto";
  int threads = 0;

  /// @param given of comparisons and of potentials: each name belongs to one of them
  /// @throws InputError (unknown names, values)
  Computation(const Settings& given, const std::string& potential, const std::string& pme_cell, std::string device,
              int threads);
  std::unique_ptr<Engine> make_engine() const;
};

/// A state as it is compared: read, selected and charged as the command line does. Arrays that have charges keep them;
/// others get them from PDB2PQR as files do.
/// @param source the loaded source, for a target
/// @throws as load_for(); InputError (assembly or topology for a state of arrays)
LoadedState load(const State& state, StateRole role, const Computation& computation, const Molecule* source,
                 const Progress& progress);

/// A state of arrays, as it is.
LoadedState loaded_arrays(const State& state);

/// A frame against a source, as load_frame(): without charges of its own it takes the source's, or is prepared like it.
/// @throws as load_frame(), load()
LoadedState load_target(const State& state, const Computation& computation, const LoadedState& source,
                        const Progress& progress);

/// The potential of states that are compared; none where maps are given.
/// @throws InputError as PotentialPlan; maps and options of computed potentials were given; `auto` finds no charges
PotentialPlan plan_potential(const Computation& computation, const std::vector<const State*>& states,
                             const std::vector<const LoadedState*>& loaded);

/// One side. Keeps references to both.
/// @param inputs receives where the map comes from
CompareInput side_of(const State& state, const LoadedState& loaded, const PotentialPlan& plan, const std::string& role,
                     std::vector<InputFile>& inputs);

/// Where a state comes from.
void note_inputs(const State& state, const LoadedState& loaded, const std::string& role,
                 std::vector<InputFile>& inputs);

/// Where PDB2PQR made the charges, the result tells what it did.
void note_preparation(const std::string& role, const LoadedState& loaded, Provenance& provenance);

/// What made a result.
/// @param inputs in any order; the result has the structures first, then the maps
Provenance provenance_of(const Engine& engine, const std::string& call, std::vector<InputFile> inputs);

}  // namespace espdiff::python
