// potential_plan.cpp: from what is asked for and the states' charges to one potential for all of them.
#include "potential/potential_plan.h"

#include "base/error.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/pdb2pqr.h"

namespace espdiff {

const std::vector<OptionRow<PotentialRequest>>& potential_request_settings() {
  using Rows = RowsOf<PotentialRequest>;
  const std::string group = "Potentials";
  static const std::vector<Rows::Row> all{
      Rows::word(
          "potential", group, {"auto", "pb", "pme", "coulomb", "none"}, [](auto& o) -> auto& { return o.potential; },
          "The potential that is computed where no maps are given. pb: in salt water, by the Poisson-Boltzmann "
          "equation. pme: particle-mesh Ewald, in a periodic cell with the water of the file. coulomb: isolated "
          "charges. auto: pb, with the salt of the ions counted where the file has explicit water (ensembles: pme "
          "there, since they average). none: compare shapes alone"),
      Rows::word(
          "pme-cell", group, {"auto", "own", "box"}, [](auto& o) -> auto& { return o.cell; },
          "Cell of pme. own: the file's (CRYST1 of each model), where the charges of water and ions count too. box: "
          "around the atoms, along their principal axes, without water. auto: own where there is water in one")};
  return all;
}

LoadedState load_for(const PotentialRequest& asked, bool wants_charges, const StructureFile& file, StateRequest request,
                     const InputOptions& options, const Progress& progress) {
  request.wants_charges = wants_charges && asked.potential != "none";
  const bool is_auto = asked.potential == "auto";
  request.may_prepare = !is_auto || !find_pdb2pqr().empty();
  try {
    return load_state(file, request, options, progress);
  } catch (const InputError& error) {
    if (!is_auto || asked.is_required || !request.wants_charges) throw;
    // Was it the preparation?
    request.wants_charges = false;
    load_state(file, request, options, progress);
    Message text = error.message() + "; " + option("potential", "none") + " compares shapes alone";
    if (text.next().empty()) text.set_next({"", {{"potential", "none"}}});
    throw InputError(text);
  }
}

PotentialFacts facts_of(const LoadedState& state) {
  return potential_facts(state.everything.size() > 0 ? state.everything : state.molecule, state.cell);
}

std::string reason_in_full(const PotentialChoice& choice) {
  if (choice.method || choice.because.empty() || !find_pdb2pqr().empty()) return choice.because;
  return choice.because + ", and PDB2PQR, which assigns some, is not there; " + kPdb2pqrRemedy;
}

PotentialPlan::PotentialPlan(const PotentialRequest& asked, const std::vector<PotentialFacts>& facts,
                             double temperature_K) {
  const PotentialChoice choice = choose_potential(asked.potential, asked.cell, facts, asked.averaged);
  because_ = reason_in_full(choice);
  own_cell_ = choice.method == PotentialMethod::kPme && choice.own_cell;
  const bool usual_cell = choose_potential(asked.potential, "auto", facts, asked.averaged).own_cell;
  if (choice.method == PotentialMethod::kPme && choice.own_cell != usual_cell)
    unusual_cell_ = choice.own_cell ? " cell own" : " cell box";
  if (!choice.method) {
    if (!asked.given.empty())
      throw InputError(option(asked.given.front().first) + " is of computed potentials, and none is computed" +
                       (because_.empty() ? "" : ": " + because_));
    return;
  }
  options_ = make_potential_options(*choice.method, with_salt(choice, asked.given), temperature_K);
  replaces_water_ = choice.ionic_strength.has_value();
  options_->because = because_;
}

std::string PotentialPlan::in_words() const {
  if (!options_) return {};
  return potential_in_words(*options_) + unusual_cell_;
}

Molecule without_salt(const Molecule& molecule) {
  std::vector<bool> keep = salt_ions(molecule);
  keep.flip();
  return keep_atoms(molecule, keep);
}

ComputedMap PotentialPlan::map_of(const LoadedState& state) const {
  if (!own_cell_) {
    Molecule solute = replaces_water_ ? without_salt(state.molecule) : state.molecule;
    std::vector<Vec3d> positions = solute.positions;
    return {std::move(solute), {std::nullopt, std::move(positions), false}, *options_};
  }
  if (!state.cell)
    throw InputError(state.molecule.name +
                     ": there is no cell (a CRYST1 record with edges above 1 A) before the atoms; add one, or take " +
                     option("pme-cell", "box"));
  return {state.everything.size() > 0 ? state.everything : state.molecule, {state.cell, {}, false}, *options_};
}

}  // namespace espdiff
