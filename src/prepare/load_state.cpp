// load_state.cpp: the order in which a state is read, selected and charged.
#include "prepare/load_state.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "align/pair_residues.h"
#include "align/protonation.h"
#include "align/residue_charges.h"
#include "base/error.h"
#include "base/not_a_number.h"
#include "base/text/joined_words.h"
#include "io/molecules/elements.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/read_component.h"
#include "io/structures/read_topology.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/pdb2pqr.h"
#include "prepare/make_whole.h"
#include "prepare/take_charges.h"

namespace espdiff {
namespace {

bool is_charged(const Molecule& molecule) {
  return std::any_of(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; });
}

/// Drops the atoms of a selection, which may be none.
/// @returns [atom] whether it was kept
std::vector<bool> leave_out(Molecule& molecule, const std::string& selection) {
  std::vector<bool> keep = select_atoms(molecule, selection, "leave-out");
  keep.flip();
  const auto n_kept = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), true));
  if (n_kept == 0)
    throw InputError(molecule.name + ": " + option("leave-out", selection) + " drops all atoms; name fewer of them");
  if (n_kept < molecule.size()) molecule = keep_atoms(molecule, keep);
  return keep;
}

/// Groups beside the chains that a selection does not take count as left out where they are this near to what it takes.
constexpr double kNearGroup_A = 8;

bool is_near(const Molecule& whole, const std::vector<std::size_t>& atoms, const Molecule& molecule) {
  return std::any_of(atoms.begin(), atoms.end(), [&](std::size_t i) {
    return std::any_of(molecule.positions.begin(), molecule.positions.end(),
                       [&](const Vec3d& p) { return norm(whole.positions[i] - p) <= kNearGroup_A; });
  });
}

/// What `whole` has besides the molecule: the residues of `not_dropped` that are false, and groups near the molecule
/// that no selection took. Water, and chains that no selection took, are not meant.
/// @param not_dropped [atom of whole] from leave_out()  @param selected [atom that was not dropped]; empty for all
std::vector<LeftOutResidue> left_out_residues(const Molecule& whole, const std::vector<bool>& not_dropped,
                                              const std::vector<bool>& selected, const Molecule& molecule) {
  const ResidueView view(whole);
  std::vector<bool> kept = not_dropped;
  for (std::size_t i = 0, k = 0; i < whole.size(); ++i) {
    if (not_dropped[i] && !selected.empty()) kept[i] = selected[k];
    k += not_dropped[i] ? 1 : 0;
  }
  std::vector<LeftOutResidue> residues;
  for (std::size_t r = 0; r < view.kinds.size(); ++r) {
    if (view.kinds[r] == ResidueKind::kWater) continue;
    std::vector<std::size_t> gone;
    bool was_dropped = false;
    for (const std::size_t i : view.atoms[r]) {
      if (!kept[i]) gone.push_back(i);
      was_dropped = was_dropped || !not_dropped[i];
    }
    if (gone.empty()) continue;
    if (!was_dropped && (view.kinds[r] != ResidueKind::kOther || !is_near(whole, gone, molecule))) continue;
    LeftOutResidue left{whole.residues[r], {}, {}, whole.charges.empty() ? kNaN : 0};
    for (const std::size_t i : gone) {
      left.atoms.push_back(whole.atoms[i]);
      left.positions.push_back(whole.positions[i]);
      if (!whole.charges.empty()) left.charge += static_cast<double>(whole.charges[i]);
    }
    const std::optional<int> known = charge_of_group(left.residue.name, gone.size());
    if (whole.charges.empty() && known && gone.size() == view.atoms[r].size()) left.charge = *known;
    residues.push_back(std::move(left));
  }
  return residues;
}

/// The states to give to the target's residues: those of the source's residues they pair with, otherwise their own.
std::vector<std::string> forced_states(const Molecule& source, const Molecule& raw, const Molecule& prepared) {
  const auto key = [](const Residue& r) { return std::tuple(r.chain, r.number, r.insertion_code); };
  const std::vector<std::string> of_source = protonation_states(source), own = protonation_states(prepared);
  std::map<std::tuple<std::string, std::int32_t, char>, std::string> state_of;
  for (std::size_t r = 0; r < own.size(); ++r) state_of[key(prepared.residues[r])] = own[r];
  const ResiduePairing pairing = pair_residues(ResidueView(source), ResidueView(prepared));
  for (const auto& [s, t] : pairing.pairs) {
    const Residue& residue = prepared.residues[t];
    if (same_residue_name(source.residues[s].name, residue.name) && !of_source[s].empty())
      state_of[key(residue)] = of_source[s];
  }
  std::vector<std::string> states;
  for (const Residue& residue : raw.residues) states.push_back(state_of[key(residue)]);
  return states;
}

std::string topology_option(StateRole role) {
  return role == StateRole::kOnly ? "topology" : std::string(to_string(role)) + "-topology";
}

/// Whether a topology lists as many atoms as a file has.
bool lists_atoms_of(const std::string& topology, const StructureFile& file, int model) {
  try {
    return read_topology(topology).names.size() == file.n_atoms(model);
  } catch (const Error&) {
    return false;  // whoever means it gives it, and learns what is wrong with it
  }
}

/// The topologies in a file's folder that list as many atoms, in alphabetical order.
std::vector<std::string> topologies_around(const StructureFile& file, int model) {
  namespace fs = std::filesystem;
  constexpr std::size_t kMostLookedAt = 50;
  const fs::path folder = fs::path(file.path()).parent_path();
  std::vector<std::string> found;
  std::error_code failed;
  for (fs::directory_iterator at(folder.empty() ? fs::path(".") : folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    fs::path name = at->path().filename();
    const fs::path whole = name;
    if (name.extension() == ".gz") name = name.stem();
    for (const char* const ending : {".psf", ".prmtop", ".parm7", ".parm", ".top"}) {
      if (name.extension() == ending && at->is_regular_file(failed)) found.push_back((folder / whole).string());
    }
  }
  std::sort(found.begin(), found.end());
  found.resize(std::min(found.size(), kMostLookedAt));
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const std::string& path) { return !lists_atoms_of(path, file, model); }),
              found.end());
  return found;
}

/// Refuses coordinates whose atoms no topology of their name lists, and names those in the folder that may be meant.
void advise_topologies_around(const StructureFile& file, int model, StateRole role) {
  const std::vector<std::string> found = topologies_around(file, model);
  if (found.empty()) return;
  const std::string named = topology_option(role);
  Message advice = found.size() == 1 ? Message(found[0] + " in its folder lists as many: ") + option(named, found[0])
                                     : Message(joined_words(found) + " in its folder list as many: choose one by ") +
                                           option(named, "FILE");
  if (found.size() == 1) advice.set_next({"", {{named, found[0]}}});
  throw InputError(file.path() + ": has the coordinates of " + std::to_string(file.n_atoms(model)) +
                   " atoms without their names; " + advice);
}

/// The error of a state whose atoms a topology beside it lists.
[[noreturn]] void advise_topology(const UnchargedError& error, const std::string& name, const std::string& topology,
                                  StateRole role) {
  const std::string named = topology_option(role);
  throw InputError(name + ": " + error.text +
                   Message("; " + topology + " beside it has charges of its atoms: " + option(named, topology))
                       .set_next({"", {{named, topology}}}));
}

/// The error of a state with the line of its first residue, and with the residues of the other state.
[[noreturn]] void refuse_uncharged(const UnchargedError& error, const std::string& name, long line,
                                   const StateRequest& request, const std::string& force_field) {
  const std::string place = line == 0 ? name : name + ":" + std::to_string(line);
  Message lack = error.text, remedy = error.remedy;
  std::vector<UnchargedResidue> residues = error.residues;
  if (request.check_partner && !residues.empty()) {
    try {
      request.check_partner();
    } catch (const UnchargedError& other) {
      lack += "; " + other.text;
      residues.insert(residues.end(), other.residues.begin(), other.residues.end());
      remedy = uncharged_remedy(residues, force_field);
    }
  }
  if (request.only_checks) throw UnchargedError(place, place + ": " + lack, remedy, error.residue, residues);
  throw InputError(place + ": " + lack + remedy);
}

/// What a side has of its own, otherwise what both sides have.
std::string option_of_side(StateRole role, const InputOptions& options, std::string SideInput::*member) {
  const std::string& own = (role == StateRole::kTarget ? options.target : options.source).*member;
  return role == StateRole::kOnly || own.empty() ? options.both.*member : own;
}

}  // namespace

std::string topology_beside(const StructureFile& file, const StructureOptions& structure) {
  namespace fs = std::filesystem;
  if (!structure.assembly.empty()) return {};
  for (const char* const ending : {".psf", ".prmtop", ".parm7"}) {
    const std::string path = fs::path(file.path()).replace_extension(ending).string();
    std::error_code missing;
    if (path != file.path() && fs::is_regular_file(path, missing) && lists_atoms_of(path, file, structure.model))
      return path;
  }
  return {};
}

Molecule read_as_it_is(const StructureFile& file, const StructureOptions& structure) {
  if (!file.needs_atoms()) return file.read(structure);
  const std::string topology = topology_beside(file, structure);
  if (!topology.empty()) return file.read_with(read_topology_atoms(topology), structure);
  Molecule nameless;
  const std::size_t n = file.n_atoms(structure.model);
  nameless.residues.emplace_back();
  nameless.atoms.resize(n);
  nameless.positions.resize(n);
  nameless.radii.assign(n, element_radius(""));
  return file.read_with(nameless, structure);
}

const char* to_string(StateRole role) {
  switch (role) {
    case StateRole::kSource: return "source";
    case StateRole::kTarget: return "target";
    case StateRole::kOnly: break;
  }
  return "molecule";
}

std::optional<Preparation> charge_molecule(Molecule& molecule, const InputOptions& options, const StateRequest& request,
                                           std::vector<ChargeFile>& files, const Progress& progress) {
  if (is_charged(molecule)) return std::nullopt;
  if (!options.charges_from.empty()) {
    const StructureFile file(options.charges_from);
    const Molecule from = file.read({1, true, false, {}});
    if (!is_charged(from))
      throw InputError(options.charges_from + ": has no charges to take (" + option("charges-from") +
                       "); give a PQR of another state of the molecule");
    take_values(molecule, from, molecule.name);
    files.push_back({"charges_from", options.charges_from, file.sha256()});
    return std::nullopt;
  }
  if (!request.may_prepare) return std::nullopt;
  if (request.only_checks) {
    require_charges(molecule, options.charges);
    return std::nullopt;
  }
  progress.report("prepare " + molecule.name, 0.0);
  ChargeOptions charges = options.charges;
  charges.force_field = force_field_for(molecule, request.source, charges.force_field);
  Prepared prepared = prepare_molecule(molecule, charges, {}, progress);
  if (options.charges.same_protonation && request.source != nullptr) {
    const double seconds = prepared.preparation.seconds;
    const std::vector<std::string> states = forced_states(*request.source, molecule, prepared.molecule);
    prepared = prepare_molecule(molecule, charges, states, progress);
    prepared.preparation.seconds += seconds;
  }
  molecule = std::move(prepared.molecule);
  return std::move(prepared.preparation);
}

LoadedState load_state(const StructureFile& file, const StateRequest& request, const InputOptions& options,
                       const Progress& progress) {
  StructureOptions structure = request.structure;
  structure.assembly = options.assembly;
  std::string topology = option_of_side(request.role, options, &SideInput::topology);
  if (topology.empty() && file.needs_atoms()) topology = topology_beside(file, structure);
  if (topology.empty() && file.needs_atoms()) advise_topologies_around(file, structure.model, request.role);
  LoadedState state;
  if (!topology.empty()) {
    if (!structure.assembly.empty())
      throw InputError(option("assembly") + " and a topology were given; a topology lists the atoms of the file");
    const Topology charges = read_topology(topology);
    const StructureOptions everything{structure.model, true, true, {}};
    state.everything =
        file.needs_atoms() ? file.read_with(read_topology_atoms(topology), everything) : file.read(everything);
    take_topology(state.everything, charges);
    state.molecule = keep_kinds(state.everything, structure);
    state.charge_files.push_back({"topology", topology, charges.sha256});
  } else {
    state.molecule = file.read(structure);
    if (request.wants_charges && is_charged(state.molecule))
      state.everything = file.read({structure.model, true, true, structure.assembly});
  }
  state.cell = file.unit_cell(structure.model);
  state.is_changed = !structure.assembly.empty();
  try {
    select_and_charge(state, request, options, progress);
    if (state.preparation) state.preparation->topology_beside = topology_beside(file, structure);
  } catch (const UnchargedError& error) {
    const std::string beside = topology_beside(file, structure);
    if (!beside.empty() && !request.only_checks) advise_topology(error, state.molecule.name, beside, request.role);
    refuse_uncharged(error, state.molecule.name, file.line_of(structure.model, error.residue), request,
                     force_field_for(state.molecule, nullptr, options.charges.force_field));
  }
  return state;
}

void select_and_charge(LoadedState& state, const StateRequest& request, const InputOptions& options,
                       const Progress& progress) {
  const std::string select = option_of_side(request.role, options, &SideInput::select);
  const char* const select_option = select == options.both.select        ? "select"
                                    : request.role == StateRole::kTarget ? "target-select"
                                                                         : "source-select";
  // The potential of everything in the cell has the cell's period, so that it is the same at an image.
  if (state.cell && options.assembly.empty()) state.n_border_bonds = make_whole(state.molecule, *state.cell);
  state.whole = state.molecule;
  std::vector<bool> not_dropped(state.whole.size(), true), selected;
  if (!options.leave_out.empty()) {
    not_dropped = leave_out(state.molecule, options.leave_out);
    state.n_left_out = state.whole.size() - state.molecule.size();
    if (state.everything.size() > 0) leave_out(state.everything, options.leave_out);
  }
  if (!select.empty()) {
    selected = select_some_atoms(state.molecule, select, select_option);
    state.molecule = keep_atoms(state.molecule, selected);
  }
  state.molecule.left_out = left_out_residues(state.whole, not_dropped, selected, state.molecule);
  if (request.wants_charges)
    state.preparation = charge_molecule(state.molecule, options, request, state.charge_files, progress);
  if (state.preparation) {
    for (const std::string& ligand : state.preparation->ligands) state.charge_files.push_back({"ligand", ligand, {}});
  }
  state.is_changed = state.is_changed || state.n_border_bonds > 0 || !select.empty() || state.n_left_out > 0 ||
                     state.preparation.has_value() || !state.charge_files.empty();
}

LoadedState load_frame(const StructureFile& file, const StructureOptions& structure, const std::string& name,
                       const Molecule& source, bool source_is_prepared, const InputOptions& options,
                       const Progress& progress, StateRole role) {
  const StateRequest request{structure, role, false, true, &source};
  LoadedState state = load_state(file, request, options, progress);
  state.molecule.name = name;
  charge_frame(state, source, source_is_prepared, request, options, progress);
  return state;
}

void charge_frame(LoadedState& state, const Molecule& source, bool source_is_prepared, const StateRequest& request,
                  const InputOptions& options, const Progress& progress) {
  if (source.charges.empty() || is_charged(state.molecule)) return;
  const std::string name = state.molecule.name;
  if (source_is_prepared && !has_same_atoms(state.molecule, source)) {
    InputOptions like_source = options;
    like_source.charges.same_protonation = true;
    state.preparation = charge_molecule(state.molecule, like_source, request, state.charge_files, progress);
  } else {
    take_values(state.molecule, source, name);
  }
  state.molecule.name = name;
}

void refuse_options_of_files(const InputOptions& options, StateRole role, const std::string& whose) {
  const bool is_target = role == StateRole::kTarget;
  const SideInput& own = is_target ? options.target : options.source;
  for (const auto& [name, text] : {std::pair("select", &options.both.select),
                                   {"leave-out", &options.leave_out},
                                   {is_target ? "target-select" : "source-select", &own.select},
                                   {"assembly", &options.assembly},
                                   {"topology", &options.both.topology},
                                   {is_target ? "target-topology" : "source-topology", &own.topology}}) {
    if (!text->empty()) throw InputError(option(name) + " is of structures in files, and " + whose);
  }
}

namespace {

void check_ligands(const InputOptions& options, const std::vector<const LoadedState*>& states) {
  for (const std::string& path : options.charges.ligands) {
    const auto has = [&](const LoadedState* state) {
      if (!state->preparation) return false;
      const std::vector<std::string>& used = state->preparation->ligands;
      return std::find(used.begin(), used.end(), path) != used.end();
    };
    if (states.empty() || std::any_of(states.begin(), states.end(), has)) continue;
    const bool any =
        std::any_of(states.begin(), states.end(), [](const auto* s) { return s->preparation.has_value(); });
    const LoadedState& first = *states.front();
    const Molecule& whole = first.whole.size() > 0 ? first.whole : first.molecule;
    throw InputError(path + ": " +
                     (!any ? "no structure is prepared that this ligand could be in"
                      : is_component_path(path)
                          ? "no residue that is prepared, and has no hydrogens yet, has name, heavy atoms and bonds of "
                            "one of its components; " +
                                whole.name + " has " + describe_chains(whole)
                          : "no residue that is prepared has heavy atoms of its names; " + whole.name + " has " +
                                describe_chains(whole)) +
                     "; leave " + option("ligand") + " out, or name its atoms as the structure does");
  }
}

}  // namespace

void check_left_out(const InputOptions& options, const std::vector<const LoadedState*>& states) {
  check_ligands(options, states);
  if (options.leave_out.empty()) return;
  const bool some = std::any_of(states.begin(), states.end(), [](const LoadedState* s) { return s->n_left_out > 0; });
  if (some || states.empty()) return;
  throw InputError(option("leave-out", options.leave_out) + " drops no atom; " + states.front()->whole.name + " has " +
                   describe_chains(states.front()->whole));
}

}  // namespace espdiff
