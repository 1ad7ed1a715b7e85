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

/// A file's molecule for a potential: with its water and ions, and its cell.
struct ChargedFile {
  Molecule everything;
  std::optional<UnitCell> cell;
};
/// @throws as StructureFile::read(), unit_cells()
ChargedFile read_charged(const StructureFile& file, int model);

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

  /// The map of a molecule with a surface.
  /// @param everything with water and ions, and its cell; read where takes_everything()
  /// @throws InputError (no cell), and as ComputedMap
  ComputedMap map_of(const Molecule& molecule, const ChargedFile& everything) const;

 private:
  std::optional<PotentialOptions> options_;
  bool own_cell_ = false;
  std::string unusual_cell_;  ///< in words, where the user chose another cell than `auto` takes
  std::string because_;
};

}  // namespace espdiff::cli
