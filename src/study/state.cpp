// state.cpp: from files, arrays and VMD's molecules to states that can be compared.
#include "study/state.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "field/given_values.h"
#include "io/files/sha256.h"
#include "io/grids/read_grid.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "prepare/charges/pdb2pqr.h"
#include "report/state_report.h"

namespace espdiff {
namespace {

/// A molecule is selected and charged as a structure file is.
/// @param drops_water where it has no charges: files are read without water
LoadedState load_molecule(const State& state, const StateRequest& request, bool drops_water, const InputOptions& input,
                          const Progress& progress) {
  LoadedState loaded;
  loaded.molecule = state.molecule;
  if (state.everything != nullptr) loaded.everything = *state.everything;
  loaded.cell = state.cell;
  if (state.is_selected) {
    refuse_options_of_files(
        input, request.role,
        std::string("the ") + to_string(request.role) + " is a molecule of VMD; choose its atoms by `sel`");
    return loaded;
  }
  for (const auto& [name, text] : {std::pair("assembly", &input.assembly),
                                   {"topology", &input.both.topology},
                                   {"source-topology", &input.source.topology},
                                   {"target-topology", &input.target.topology}}) {
    if (!text->empty())
      throw InputError(option(name) + " is of structures in files, and " + state.molecule.name +
                       " is a state of arrays; give it the atoms and charges that it is to have");
  }
  if (drops_water && !has_charges(loaded.molecule)) {
    loaded.molecule = keep_kinds(loaded.molecule, {1, true, false, {}});
    loaded.everything = {};
  }
  select_and_charge(loaded, request, input, progress);
  return loaded;
}

/// The map of a state's own potential. For a file with water in a cell, pme takes all of it.
ComputedMap own_map(const StatePotential& own, const LoadedState& state, double temperature_K) {
  const PotentialOptions options = own.options(temperature_K);
  ChargeSurroundings surroundings = own.surroundings;
  if (own.charges.size() > 0) {
    surroundings.solute = state.molecule.positions;
    return {own.charges, surroundings, options};
  }
  const bool is_in_water = state.everything.size() > 0 && potential_facts(state.everything, state.cell).has_solvent;
  const bool is_padded =
      std::any_of(own.given.begin(), own.given.end(), [](const auto& setting) { return setting.first == "pad"; });
  if (own.method == PotentialMethod::kPme && !is_padded &&
      (is_in_water || (options.cell && state.everything.size() > 0)))
    return {state.everything, {state.cell, {}, false}, options};
  // Chosen because of the water, whose place it takes: see PotentialPlan.
  const bool replaces_water = own.method == PotentialMethod::kPoissonBoltzmann && is_in_water && !own.because.empty();
  return {replaces_water ? without_salt(state.molecule) : state.molecule, surroundings, options};
}

std::string map_role(const ComparedState& state) { return state.role == "structure" ? "map" : state.role + "_map"; }

}  // namespace

PotentialOptions StatePotential::options(double temperature_K) const {
  PotentialOptions options = make_potential_options(method, given, temperature_K);
  options.cell = cell;
  options.because = because;
  return options;
}

void ComparedState::take_parts(SurfaceParts made) {
  if (!made.region.empty()) parts.region = std::move(made.region);
  parts.patches = std::move(made.patches);
}

StateReader::StateReader(const StatesRequest& request, std::vector<StatePtr> given, const Progress& progress)
    : request_(request), given_(std::move(given)), progress_(progress) {
  has_maps_ = std::any_of(given_.begin(), given_.end(), [](const StatePtr& state) { return state->has_map(); });
}

StateReader::~StateReader() = default;

bool StateReader::wants_charges(const State& state) const {
  return state.potential || (!request_.each_by_itself && !has_maps_ && request_.potential.potential != "none");
}

const StructureFile& StateReader::open(const State& state) {
  if (state.file != nullptr) return *state.file;
  if (file_ == nullptr || path_ != state.path) {
    file_ = nullptr;  // frees its text first
    file_ = std::make_shared<const StructureFile>(state.path);
    path_ = state.path;
  }
  file_->require_unchanged(state.input.sha256);
  return *file_;
}

LoadedState StateReader::load(const State& state, const StateRequest& request) {
  const InputOptions& input = request_.options.input;
  const bool is_auto = state.potential ? !state.potential->because.empty() : request_.potential.potential == "auto";
  StateRequest tried = request;
  tried.may_prepare = state.potential || !is_auto || !find_pdb2pqr().empty();
  const auto once = [&] {
    return state.path.empty() ? load_molecule(state, tried, tried.wants_charges, input, progress_)
                              : load_state(open(state), tried, input, progress_);
  };
  try {
    return once();
  } catch (const InputError& error) {
    if (!is_auto || !tried.wants_charges || tried.only_checks) throw;
    tried.wants_charges = false;
    once();  // or was it the preparation?
    if (state.potential) throw InputError(error.message() + "; `map none` compares shapes alone");
    Message text = error.message() + "; " + option("potential", "none") + " compares shapes alone";
    if (text.next().empty()) text.set_next({"", {{"potential", "none"}}});
    throw InputError(text);
  }
}

void StateReader::start_ahead(StateRole role) {
  ahead_ = std::move(next_ahead_);
  const bool has_next = role != StateRole::kTarget && next_ + 1 < given_.size();
  const InputOptions& input = request_.options.input;
  // With the source's protonation it needs the source; trajectories share the reader of their frames.
  if (request_.n_threads < 2 || !has_next || input.charges.same_protonation || !input.charges_from.empty()) return;
  const StatePtr state = given_[next_ + 1], before = given_[next_];
  // The same molecule takes its charges from the cache.
  if (state->path == before->path && state->structure.model == before->structure.model) return;
  if (state->path.empty() || state->file != nullptr || !wants_charges(*state) || find_pdb2pqr().empty()) return;
  const StateRequest request{state->structure, role == StateRole::kSource ? StateRole::kTarget : role};
  next_ahead_ = std::make_unique<StateAhead>([state, request, &input](const Progress& progress) {
    auto file = std::make_shared<const StructureFile>(state->path);
    file->require_unchanged(state->input.sha256);
    LoadedState loaded = load_state(*file, request, input, progress);
    return StateAhead::Read{std::move(file), std::move(loaded)};
  });
}

std::optional<LoadedState> StateReader::take_ahead(const Molecule* source) {
  const std::unique_ptr<StateAhead> ahead = std::move(ahead_);
  if (ahead == nullptr) return std::nullopt;
  std::optional<StateAhead::Read> read = ahead->take(progress_);
  if (!read) return std::nullopt;
  const std::string& asked = request_.options.input.charges.force_field;
  if (read->state.preparation) {
    // Nucleotides of the source change the force field, those of this state alone are refused.
    const Molecule& molecule = read->state.molecule;
    if (force_field_for(molecule, source, asked) != force_field_for(molecule, nullptr, asked)) return std::nullopt;
    progress_.report("prepare " + molecule.name, 1.0);
  }
  file_ = std::move(read->file);
  path_ = given_.at(next_)->path;
  return std::move(read->state);
}

ComparedState StateReader::read(StateRole role, const Molecule* source, const State* partner) {
  start_ahead(role);
  if (std::optional<LoadedState> loaded = take_ahead(source))
    return compared(*given_[next_++], role, *std::move(loaded));
  const State& given = *given_.at(next_++);
  StateRequest request{given.structure, role};
  request.wants_charges = wants_charges(given);
  request.source = source;
  if (partner != nullptr && !partner->path.empty()) {
    request.check_partner = [this, partner] {
      StateRequest other{partner->structure, StateRole::kTarget, wants_charges(*partner)};
      other.only_checks = true;
      const StructureFile file(partner->path);
      load_state(file, other, request_.options.input, progress_);
    };
  }
  return compared(given, role, load(given, request));
}

ComparedState StateReader::read_frame(const LoadedState& source) {
  ahead_ = std::move(next_ahead_);
  ahead_.reset();
  const State& given = *given_.at(next_);
  if (given.has_map() || !has_charges(source.molecule)) return read(StateRole::kTarget, &source.molecule);
  ++next_;
  const InputOptions& input = request_.options.input;
  const StateRequest request{given.structure, StateRole::kTarget, false, true, &source.molecule};
  LoadedState loaded = given.path.empty() ? load_molecule(given, request, true, input, progress_)
                                          : load_state(open(given), request, input, progress_);
  charge_frame(loaded, source.molecule, source.preparation.has_value(), request, input, progress_);
  return compared(given, StateRole::kTarget, std::move(loaded));
}

ComparedState StateReader::compared(const State& given, StateRole role, LoadedState loaded) {
  ComparedState state;
  state.role = role == StateRole::kOnly ? "structure" : to_string(role);
  state.loaded = std::move(loaded);
  InputFile input = given.input;
  if (!given.path.empty()) input = {{}, given.path, open(given).sha256(), nullptr, given.structure};
  input.role = state.role;
  state.inputs = state_inputs(state.role, input, state.loaded);
  state.parts.region = given.region;
  if (given.given == nullptr) return state;
  state.fields.given = given.given;
  std::string names;
  for (const std::string& name : given.given->names()) names += (names.empty() ? "" : ", ") + name;
  state.inputs.push_back({state.role == "structure" ? "array" : state.role + "_array",
                          names + " of " + state.loaded.molecule.name,
                          sha256_of(given.given->bytes()),
                          {},
                          {}});
  return state;
}

PotentialPlan StateReader::add_maps(const std::vector<ComparedState*>& states) {
  std::vector<const LoadedState*> loaded;
  std::vector<PotentialFacts> facts;
  for (const ComparedState* state : states) {
    loaded.push_back(&state->loaded);
    facts.push_back(facts_of(state->loaded));
  }
  const bool takes_options = std::none_of(given_.begin(), given_.end(), [](const auto& s) { return s->is_selected; });
  if (takes_options && states.size() > 1) check_left_out(request_.options.input, loaded);
  const PotentialRequest& asked = request_.potential;
  if (has_maps_ && !request_.each_by_itself && (asked.potential != "auto" || !asked.given.empty()))
    throw InputError(option("potential") + " and its options are of computed potentials, and maps were given");
  PotentialPlan plan;
  if (!request_.each_by_itself && !has_maps_) {
    plan = PotentialPlan(asked, facts, request_.options.temperature_K);
    if (request_.refuses_shapes && !plan.computes() && asked.potential != "none")
      throw InputError(plan.because() + "; " + option("potential", "none") + " compares shapes alone");
  }
  for (std::size_t i = 0; i < states.size(); ++i)
    add_map(*given_.at(i), plan, request_.options.temperature_K, *states[i]);
  return plan;
}

void read_given_map(State& state) {
  if (state.map != nullptr || state.map_path.empty()) return;
  GridOptions options;
  options.array = state.map_array;
  options.unit = state.map_unit;
  GridFile read = read_grid_file(state.map_path, options);
  state.map_input = {{}, state.map_path, std::move(read.sha256)};
  state.map = std::make_shared<const Grid>(std::move(read.grid));
}

ComputedMap computed_map(const State& given, const PotentialPlan& plan, double temperature_K,
                         const LoadedState& state) {
  return given.potential ? own_map(*given.potential, state, temperature_K) : plan.map_of(state);
}

void add_map(const State& given, const PotentialPlan& plan, double temperature_K, ComparedState& state) {
  InputFile input = given.map_input;
  if (given.potential || plan.computes()) {
    const ComputedMap map = computed_map(given, plan, temperature_K, state.loaded);
    state.make_map = map.maker();
    input = computed_input({}, map);
  } else if (given.map != nullptr || given.make_map != nullptr) {
    state.map = given.map;
    state.make_map = given.make_map;
  } else if (!given.map_path.empty()) {
    State file;
    file.map_path = given.map_path;
    file.map_array = given.map_array;
    file.map_unit = given.map_unit;
    read_given_map(file);
    return add_map(file, plan, temperature_K, state);
  } else {
    return;
  }
  input.role = map_role(state);
  state.map_inputs = {std::move(input)};
}

std::string potential_in_words(const PotentialPlan& plan, const std::vector<StatePtr>& given, double temperature_K) {
  if (plan.computes()) return plan.in_words();
  for (const StatePtr& state : given) {
    if (state->potential)
      return potential_in_words(
          make_potential_options(state->potential->method, state->potential->given, temperature_K));
  }
  return "maps";
}

}  // namespace espdiff
