// potential_plan.h: how the potentials of states that are compared with each other are computed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "potential/choose_potential.h"
#include "potential/computed_map.h"
#include "potential/potential_settings.h"
#include "prepare/load_state.h"

namespace espdiff {

/// What is asked for of potentials that are computed.
struct PotentialRequest {
  std::string potential = "auto";  ///< auto, none, pme, coulomb or pb
  std::string cell = "auto";       ///< of pme: own, box or auto
  GivenPotentialSettings given;
  bool averaged = false;     ///< the potentials of many frames are averaged; see choose_potential()
  bool is_required = false;  ///< shapes alone would be no answer
};

/// Its options besides those of each potential, potential_settings().
const std::vector<OptionRow<PotentialRequest>>& potential_request_settings();

/// Loads a state that is to be compared: with charges where a potential is asked for or, for auto, where charges
/// can be had.
/// @param wants_charges false where maps are given
/// @throws as load_state(); for auto, unless one is required, the message adds how shapes alone are compared
LoadedState load_for(const PotentialRequest& asked, bool wants_charges, const StructureFile& file, StateRequest request,
                     const InputOptions& options, const Progress& progress);
/// What a state brings for a potential.
PotentialFacts facts_of(const LoadedState& state);

/// The reason of a choice; where no potential is computed for lack of charges, also what would assign some.
std::string reason_in_full(const PotentialChoice& choice);

/// The atoms besides salt_ions(), which a continuum stands for where it takes the place of explicit water.
Molecule without_salt(const Molecule& molecule);

/// How the potentials of all sides are computed; nothing where none are.
class PotentialPlan {
 public:
  PotentialPlan() = default;
  /// @param facts of all molecules. @throws InputError as choose_potential(), make_potential_options()
  PotentialPlan(const PotentialRequest& asked, const std::vector<PotentialFacts>& facts, double temperature_K);

  bool computes() const { return options_.has_value(); }
  /// Whether water and ions count, and the cell of their file.
  bool takes_everything() const { return own_cell_; }
  /// Why nothing is computed, where that was not asked for.
  const std::string& because() const { return because_; }
  /// All that the maps depend on besides the molecules; empty where none are computed.
  std::string in_words() const;

  /// The map of a state; where takes_everything() of all its atoms, in its cell.
  /// @throws InputError (no cell), and as ComputedMap
  ComputedMap map_of(const LoadedState& state) const;

 private:
  std::optional<PotentialOptions> options_;
  bool own_cell_ = false;
  bool replaces_water_ = false;  ///< a continuum stands for explicit water and the ions in it
  std::string unusual_cell_;     ///< in words, where the user chose another cell than `auto` takes
  std::string because_;
};

}  // namespace espdiff
