// map_options.h: the potentials of two sides on the command line: maps in files, or computed ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/structure_options.h"
#include "cli/options.h"
#include "io/structure_file.h"
#include "potential/choose_potential.h"
#include "potential/computed_map.h"
#include "prepare/load_state.h"
#include "report/provenance.h"

namespace espdiff {
class StructureFile;
}

namespace espdiff::cli {

/// Options of potentials computed instead of read.
struct ComputedMapArguments {
  std::string potential = "auto", cell = "auto";
  GivenPotentialSettings given;
};
void add_computed_map_options(CLI::App& parser, ComputedMapArguments& arguments);

struct MapArguments : ComputedMapArguments {
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;
};
void add_map_options(CLI::App& parser, MapArguments& arguments);
/// Whether maps are read.
inline bool has_given_maps(const MapArguments& a) { return !(a.source_map.empty() && a.target_map.empty()); }
/// @throws InputError (computed and given maps)
void check_map_options(const MapArguments& arguments);

/// The file's map of a side, "source" or "target"; nothing where none was given. Adds to `inputs`.
std::optional<Grid> given_map(const MapArguments& arguments, const std::string& role, std::vector<InputFile>& inputs);

/// Loads a state for the verbs that compare: with charges where a potential is asked for or, for auto, where charges
/// can be had.
/// @param wants_charges false where maps are given
/// @throws as load_state(); for auto the message adds how shapes alone are compared
LoadedState load_for(const ComputedMapArguments& arguments, bool wants_charges, const StructureFile& file,
                     StateRequest request, const InputOptions& options, const Progress& progress);
/// What a state brings for a potential.
PotentialFacts facts_of(const LoadedState& state);

/// How the potentials of all sides are computed; nothing where none are.
class PotentialPlan {
 public:
  PotentialPlan() = default;
  /// @param facts of all molecules. @throws InputError as choose_potential(), make_potential_options()
  PotentialPlan(const ComputedMapArguments& arguments, const std::vector<PotentialFacts>& facts, double temperature_K);

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
  std::string unusual_cell_;  ///< in words, where the user chose another cell than `auto` takes
  std::string because_;
};

}  // namespace espdiff::cli
