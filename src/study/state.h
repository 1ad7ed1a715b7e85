// state.h: a state of a molecule as it is given to a study, and as it is compared.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/molecule/unit_cell.h"
#include "base/progress.h"
#include "base/types.h"
#include "mapping/input.h"
#include "potential/computed_map.h"
#include "potential/potential_plan.h"
#include "prepare/load_state.h"
#include "report/sections/provenance.h"
#include "study/state_ahead.h"

namespace espdiff {

struct CompareOptions;
class GivenValues;
class StructureFile;

/// A potential that one state has by itself, of charges that may be more than its molecule's (Tcl: `map pb`).
struct StatePotential {
  PotentialMethod method = PotentialMethod::kPme;
  GivenPotentialSettings given;
  std::string because;          ///< why this potential, where the user did not ask for it
  std::optional<PmeCell> cell;  ///< given
  Molecule charges;             ///< positions, charges and radii only; empty: the state's molecule has them
  ChargeSurroundings surroundings;

  PotentialOptions options(double temperature_K) const;
};

/// A state as it is given: a structure file or a molecule, and its map where there is one.
struct State {
  std::string path;                           ///< of a structure file; empty for a molecule
  std::shared_ptr<const StructureFile> file;  ///< the same where it is open already
  StructureOptions structure;
  Molecule molecule;                           ///< where `path` is empty
  bool is_selected = false;                    ///< its atoms were chosen in VMD: it takes no selection or charges
  std::shared_ptr<const Molecule> everything;  ///< of a molecule: with water and ions, whose charges count for pme
  std::optional<UnitCell> cell;                ///< of a molecule
  InputFile input;                   ///< of a molecule, without role; of a file its SHA-256 where it has to be that
  std::vector<std::uint8_t> region;  ///< [residue] nonzero in the region; empty: by the options
  std::shared_ptr<const GivenValues> given{};  ///< values of its atoms for fields; null for none

  std::string map_path, map_array, map_unit;  ///< of a map's file
  std::shared_ptr<const Grid> map;            ///< a map from memory, or a file's that was read already
  MapMaker make_map = nullptr;                ///< instead of `map`
  InputFile map_input;                        ///< of `map` and `make_map`, without role
  std::optional<StatePotential> potential;    ///< instead of the study's
  std::string shapes_because;                 ///< why it has no potential, where nobody asked for that

  bool has_map() const { return !map_path.empty() || map != nullptr || make_map != nullptr; }
};

using StatePtr = std::shared_ptr<const State>;

/// A state as it is compared.
struct ComparedState {
  std::string role;    ///< "source", "target", "structure"
  LoadedState loaded;  ///< its molecule has the surface
  std::shared_ptr<const Grid> map;
  MapMaker make_map = nullptr;
  SurfaceParts parts;
  FieldInput fields;
  std::vector<InputFile> inputs;      ///< the structure, and files with charges
  std::vector<InputFile> map_inputs;  ///< of the map, where there is one

  /// The atoms that regions refer to.
  const Molecule& whole() const { return loaded.whole.size() > 0 ? loaded.whole : loaded.molecule; }
  /// Takes patches, and a region unless the state was given one.
  void take_parts(SurfaceParts made);
  /// Refers to this state.
  CompareInput side() const { return {&loaded.molecule, map.get(), make_map, parts, fields}; }
};

/// What the states of a study have in common.
struct StatesRequest {
  const CompareOptions& options;
  PotentialRequest potential;
  bool each_by_itself = false;  ///< states have the maps and potentials that they were given, and no other
  bool refuses_shapes = false;  ///< an error where `auto` finds no charges
  int n_threads = 1;            ///< with two or more, the next state is read and charged beside each one
};

/// Reads the states of one study, in their order, then computes or reads their maps. Keeps references.
class StateReader {
 public:
  StateReader(const StatesRequest& request, std::vector<StatePtr> given, const Progress& progress);
  ~StateReader();

  /// Reads, selects and charges the next state. A structure file that follows itself is read once.
  /// @param source the source's molecule, for a target with its protonation states
  /// @param partner the state that is read next, whose residues without charges are in the error of this one's
  /// @throws as load_state(), load_for(); InputError (options of files for a molecule that takes none)
  ComparedState read(StateRole role, const Molecule* source = nullptr, const State* partner = nullptr);
  /// Reads the next state as a frame of a series: without charges of its own it takes the source's, or is prepared like
  /// it. @throws as read(), charge_frame()
  ComparedState read_frame(const LoadedState& source);
  /// Maps for states that were read, and the checks of all of them together.
  /// @param states those of `given`, in that order
  /// @returns how potentials are computed
  /// @throws InputError (an option that dropped nothing; given maps, and settings of computed ones), as PotentialPlan
  PotentialPlan add_maps(const std::vector<ComparedState*>& states);

 private:
  bool wants_charges(const State& state) const;
  const StructureFile& open(const State& state);
  /// Starts to read the state after the next one, where it is a file that needs no other state.
  void start_ahead(StateRole role);
  /// The next state, where it was read ahead and the source changes nothing about it.
  std::optional<LoadedState> take_ahead(const Molecule* source);
  LoadedState load(const State& state, const StateRequest& request);
  ComparedState compared(const State& given, StateRole role, LoadedState loaded);

  StatesRequest request_;
  std::vector<StatePtr> given_;
  const Progress& progress_;
  bool has_maps_;
  std::size_t next_ = 0;
  std::shared_ptr<const StructureFile> file_;
  std::string path_;
  std::unique_ptr<StateAhead> ahead_, next_ahead_;  ///< of the next state, of the one after it
};

/// Reads the map's file, if it is one that was not read yet. @throws as read_grid_file()
void read_given_map(State& state);

/// The potential of a state, of its own or by a plan that computes. @throws as PotentialPlan::map_of(), ComputedMap
ComputedMap computed_map(const State& given, const PotentialPlan& plan, double temperature_K, const LoadedState& state);

/// The map of one state, by a plan that was made before. @throws as read_grid_file(), ComputedMap
void add_map(const State& given, const PotentialPlan& plan, double temperature_K, ComparedState& state);

/// The potential of a plan, or of a state by itself, in words; "maps" where none is computed.
std::string potential_in_words(const PotentialPlan& plan, const std::vector<StatePtr>& given, double temperature_K);

}  // namespace espdiff
