// map_options.cpp: options of maps, given or computed.
#include "cli/map_options.h"

#include <utility>

#include "base/error.h"
#include "io/files/write_csv.h"
#include "potential/potential.h"

namespace espdiff::cli {
namespace {

constexpr const char* kGroup = "Potentials";

}  // namespace

void add_computed_map_options(CLI::App& p, PotentialRequest& a) {
  p.add_option(
       "--potential", a.potential,
       "The potential that is computed where no maps are given. pb: in salt water, by the Poisson-Boltzmann "
       "equation. pme: particle-mesh Ewald, in a periodic cell with the water of the file. coulomb: isolated "
       "charges. auto: pb, with the salt of the ions counted where the file has explicit water (ensembles: pme there, "
       "since they average). none: compare shapes alone")
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

State with_given_map(const MapArguments& a, bool is_source) {
  State state;
  state.map_path = is_source ? a.source_map : a.target_map;
  state.map_unit = is_source ? a.source_map_unit : a.target_map_unit;
  state.map_array = a.map_array;
  return state;
}

}  // namespace espdiff::cli
