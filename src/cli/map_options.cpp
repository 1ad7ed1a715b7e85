// map_options.cpp: options of maps, given or computed.
#include "cli/map_options.h"

#include <utility>

#include "io/write_csv.h"

namespace espdiff::cli {
namespace {

constexpr const char* kGroup = "Potentials";

}  // namespace

void add_computed_map_options(CLI::App& p, ComputedMapArguments& a) {
  p.add_option("--potential", a.potential,
               "Compute the potentials instead of reading maps: pme, from the charges of the atoms")
      ->check(CLI::IsMember({"pme"}))
      ->group(kGroup);
  p.add_option("--pme-cell", a.cell,
               "Cell of a computed potential. box: 10 A wider than the atoms on each side, ignoring the file's cell. "
               "own: the file's (CRYST1 of each model), including the charges of water and ions")
      ->check(CLI::IsMember({"box", "own"}))
      ->capture_default_str()
      ->group(kGroup);
  p.add_option("--pme-grid", a.grid,
               "Grid of a computed potential: a resolution below 8 A, or numbers of points (see `espdiff potential`)")
      ->capture_default_str()
      ->group(kGroup);
  p.add_option("--ewaldfactor", a.ewald_factor, "Smearing of the charges in a computed potential, 1/A")
      ->capture_default_str()
      ->check(finite_number())
      ->group(kGroup);
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
  if (is_computed(a) && !(a.source_map.empty() && a.target_map.empty()))
    throw InputError("--potential computes both maps; leave out --source-map and --target-map, or --potential");
}

std::optional<Grid> given_map(const MapArguments& a, const std::string& role, std::vector<InputFile>& inputs) {
  const bool is_source = role == "source";
  const std::string& path = is_source ? a.source_map : a.target_map;
  if (path.empty()) return std::nullopt;
  GridFile map = read_map(path, a.map_array, is_source ? a.source_map_unit : a.target_map_unit);
  inputs.push_back({role + "_map", path, map.sha256});
  return std::move(map.grid);
}

ComputedMap computed_map(const ComputedMapArguments& a, Molecule charges, const std::optional<UnitCell>& cell,
                         double temperature_K) {
  PotentialOptions options;
  options.grid = parse_grid_choice(a.grid);
  options.pme.ewald_factor = a.ewald_factor;
  options.pme.temperature_K = temperature_K;
  if (!takes_own_cell(a)) return {std::move(charges), std::nullopt, options};
  if (!cell)
    throw InputError(charges.name +
                     ": there is no cell (a CRYST1 record with edges above 1 A) before the atoms; add one, or take "
                     "--pme-cell box");
  return {std::move(charges), cell, options};
}

ComputedMap computed_map_of_file(const ComputedMapArguments& a, const StructureFile& file, int model,
                                 const Molecule& molecule, double temperature_K) {
  if (!takes_own_cell(a)) return computed_map(a, molecule, std::nullopt, temperature_K);
  const auto cell = file.unit_cells().at(static_cast<std::size_t>(model - 1));
  return computed_map(a, file.read({model, true, true}), cell, temperature_K);
}

std::string map_in_words(const ComputedMapArguments& a) {
  return a.potential + ", cell " + a.cell + ", grid " + a.grid + ", Ewald factor " + csv_number(a.ewald_factor);
}

}  // namespace espdiff::cli
