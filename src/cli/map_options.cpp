// map_options.cpp: options of maps, given or computed.
#include "cli/map_options.h"

#include <utility>

#include "base/error.h"
#include "io/structure_file.h"
#include "io/write_csv.h"
#include "potential/potential.h"
#include "prepare/pdb2pqr.h"

namespace espdiff::cli {
namespace {

constexpr const char* kGroup = "Potentials";

}  // namespace

void add_computed_map_options(CLI::App& p, ComputedMapArguments& a) {
  p.add_option("--potential", a.potential,
               "The potential that is computed where no maps are given. pb: in salt water, by the Poisson-Boltzmann "
               "equation. pme: particle-mesh Ewald, in a periodic cell with the water of the file. coulomb: isolated "
               "charges. auto: pme with explicit water in a periodic cell, pb for other charges. none: compare shapes "
               "alone")
      ->check(CLI::IsMember({"auto", "pb", "pme", "coulomb", "none"}))
      ->capture_default_str()
      ->group(kGroup);
  p.add_option(
       "--pme-cell", a.cell,
       "Cell of pme. own: the file's (CRYST1 of each model), where the charges of water and ions count too. "
       "box: around the atoms, along their principal axes, without water. auto: own where there is water in one")
      ->check(CLI::IsMember({"auto", "own", "box"}))
      ->capture_default_str()
      ->group(kGroup);
  add_potential_settings(p, a.given, false);
}

void add_map_options(CLI::App& p, MapArguments& a) {
  p.add_option("--source-map", a.source_map,
               "Potential around the source: DX, VTI or cube, in the structure file's coordinates")
      ->group(kGroup);
  p.add_option("--target-map", a.target_map, "Potential around the target")->group(kGroup);
  p.add_option("--source-map-unit", a.source_map_unit,
               "Unit of the source map if the file does not give it: kT/e, mV, V, kcal/mol/e, hartree/e")
      ->group(kGroup);
  p.add_option("--target-map-unit", a.target_map_unit, "Unit of the target map if the file does not give it")
      ->group(kGroup);
  p.add_option("--map-array", a.map_array, "Array of VTI maps with several")->group(kGroup);
  add_computed_map_options(p, a);
}

void check_map_options(const MapArguments& a) {
  if (!has_given_maps(a)) return;
  if (a.potential != "auto")
    throw InputError(option("potential") + " computes both maps; leave out " + option("source-map") + " and " +
                     option("target-map") + ", or " + option("potential"));
  if (!a.given.empty())
    throw InputError(option(a.given.front().first) +
                     " is of computed potentials, and maps were given; leave out one of them");
}

std::optional<Grid> given_map(const MapArguments& a, const std::string& role, std::vector<InputFile>& inputs) {
  const bool is_source = role == "source";
  const std::string& path = is_source ? a.source_map : a.target_map;
  if (path.empty()) return std::nullopt;
  GridFile map = read_map(path, a.map_array, is_source ? a.source_map_unit : a.target_map_unit);
  inputs.push_back({role + "_map", path, map.sha256});
  return std::move(map.grid);
}

LoadedState load_for(const ComputedMapArguments& a, bool wants_charges, const StructureFile& file, StateRequest request,
                     const InputOptions& options, const Progress& progress) {
  request.wants_charges = wants_charges && a.potential != "none";
  const bool is_auto = a.potential == "auto";
  request.may_prepare = !is_auto || !find_pdb2pqr().empty();
  try {
    return load_state(file, request, options, progress);
  } catch (const InputError& error) {
    if (!is_auto || !request.wants_charges) throw;
    // Was it the preparation?
    request.wants_charges = false;
    load_state(file, request, options, progress);
    throw InputError(error.message() + "; " + option("potential", "none") + " compares shapes alone");
  }
}

PotentialFacts facts_of(const LoadedState& state) {
  return potential_facts(state.everything.size() > 0 ? state.everything : state.molecule, state.cell);
}

PotentialPlan::PotentialPlan(const ComputedMapArguments& a, const std::vector<PotentialFacts>& facts,
                             double temperature_K) {
  const PotentialChoice choice = choose_potential(a.potential, a.cell, facts);
  because_ = choice.because;
  if (!choice.method && !because_.empty() && find_pdb2pqr().empty())
    because_ += std::string(", and PDB2PQR, which assigns some, is not there; ") + kPdb2pqrRemedy;
  own_cell_ = choice.method == PotentialMethod::kPme && choice.own_cell;
  const bool usual_cell = choose_potential(a.potential, "auto", facts).own_cell;
  if (choice.method == PotentialMethod::kPme && choice.own_cell != usual_cell)
    unusual_cell_ = choice.own_cell ? " cell own" : " cell box";
  if (!choice.method) {
    if (!a.given.empty())
      throw InputError(option(a.given.front().first) + " is of computed potentials, and none is computed" +
                       (because_.empty() ? "" : ": " + because_));
    return;
  }
  options_ = make_potential_options(*choice.method, a.given, temperature_K);
  options_->because = because_;
}

std::string PotentialPlan::in_words() const {
  if (!options_) return {};
  return potential_in_words(*options_) + unusual_cell_;
}

ComputedMap PotentialPlan::map_of(const LoadedState& state) const {
  if (!own_cell_) return {state.molecule, {std::nullopt, state.molecule.positions, false}, *options_};
  if (!state.cell)
    throw InputError(state.molecule.name +
                     ": there is no cell (a CRYST1 record with edges above 1 A) before the atoms; add one, or take "
                     "--pme-cell box");
  return {state.everything.size() > 0 ? state.everything : state.molecule, {state.cell, {}, false}, *options_};
}

}  // namespace espdiff::cli
