// map_options.h: the potentials of two sides on the command line: maps in files, or computed ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "io/read_unit_cells.h"
#include "pipeline/computed_map.h"
#include "pipeline/write_compare.h"

namespace espdiff::cli {

struct MapArguments {
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;
  std::string potential, grid = usual_grid(false), cell = "box";
  double ewald_factor = PmeOptions().ewald_factor;
};
void add_map_options(CLI::App& parser, MapArguments& arguments);
/// Those of computed maps alone.
void add_computed_options(CLI::App& parser, MapArguments& arguments);
/// @throws InputError (computed and given maps)
void check_map_options(const MapArguments& arguments);

inline bool is_computed(const MapArguments& arguments) { return !arguments.potential.empty(); }
/// Whether charges of water and ions count, and the file's cell is taken.
inline bool takes_own_cell(const MapArguments& arguments) { return arguments.cell == "own"; }

/// The file's map of a side, "source" or "target"; nothing where none was given. Adds to `inputs`.
std::optional<Grid> given_map(const MapArguments& arguments, const std::string& role, std::vector<InputFile>& inputs);

/// The map that is computed from a molecule's charges.
/// @param cell of the molecule's file; counts with --pme-cell own only, and has to be there then
/// @throws InputError
ComputedMap computed_map(const MapArguments& arguments, Molecule charges, const std::optional<UnitCell>& cell,
                         double temperature_K);

}  // namespace espdiff::cli
