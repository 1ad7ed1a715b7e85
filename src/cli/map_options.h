// map_options.h: the potentials of two sides on the command line: maps in files, or computed ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "io/read_structure.h"
#include "potential/computed_map.h"
#include "report/write_compare.h"

namespace espdiff::cli {

/// Options of potentials computed instead of read.
struct ComputedMapArguments {
  std::string potential;  ///< empty: none
  std::string grid = usual_grid(false), cell = "box";
  double ewald_factor = PmeOptions().ewald_factor;
};
void add_computed_map_options(CLI::App& parser, ComputedMapArguments& arguments);

struct MapArguments : ComputedMapArguments {
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;
};
void add_map_options(CLI::App& parser, MapArguments& arguments);
/// @throws InputError (computed and given maps)
void check_map_options(const MapArguments& arguments);

inline bool is_computed(const ComputedMapArguments& arguments) { return !arguments.potential.empty(); }
/// Whether to include the charges of water and ions, and use the file's cell.
inline bool takes_own_cell(const ComputedMapArguments& arguments) { return arguments.cell == "own"; }

/// The given map of a side, "source" or "target"; empty if none was given. Adds to `inputs`.
std::optional<Grid> given_map(const MapArguments& arguments, const std::string& role, std::vector<InputFile>& inputs);

/// The map computed from a molecule's charges.
/// @param cell of the molecule's file; required with --pme-cell own, ignored otherwise
/// @throws InputError
ComputedMap computed_map(const ComputedMapArguments& arguments, Molecule charges, const std::optional<UnitCell>& cell,
                         double temperature_K);

/// The same for one model of a file, `molecule` has its surface atoms.
ComputedMap computed_map_of_file(const ComputedMapArguments& arguments, const StructureFile& file, int model,
                                 const Molecule& molecule, double temperature_K);
/// "pme, cell box, grid 1, Ewald factor 0.25"
std::string map_in_words(const ComputedMapArguments& arguments);

}  // namespace espdiff::cli
