// map_recipe.h: what a computed potential was made of, and what its computation reports.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"

namespace espdiff {

struct Molecule;

/// Where the zero of a potential lies: nowhere else than far away for isolated molecules; in a periodic cell its mean,
/// or the mean over its bulk solvent.
enum class ZeroPlace { kFarAway, kCellMean, kBulkSolvent };

/// Enough to compute the map again. What is known when it has been computed only stands under `made`.
struct MapRecipe {
  PotentialMethod method = PotentialMethod::kPme;
  std::string charges_from;  ///< a file, or what VMD calls the molecule
  std::size_t n_charges = 0;
  double net_charge = 0;
  bool has_water = false;  ///< explicit water among the charges
  int n_frames = 1;        ///< that the potential is the mean of
  std::string because;     ///< why this potential, where it was not asked for

  std::string cell_from;  ///< of pme: "given", "its own", or "padded"
  PmeOptions pme;         ///< with the grid's size once it was made
  PmeCell cell;           ///< in the molecule's own frame; a padded one in the comparison's, once it was made
  CoulombOptions coulomb;
  PoissonBoltzmannOptions pb;
  double pb_spacing_A = 0;

  bool made = false;
  ZeroPlace zero = ZeroPlace::kFarAway;
  double subtracted = 0;     ///< kT/e, to move the zero there
  double bulk_fraction = 0;  ///< of pme: share of the cell's points farther than 10 A from the solute
  Lattice pb_lattice;        ///< in the comparison's frame
  PoissonBoltzmannReport pb_report;
};

/// A potential on the device, and what it was made of.
struct MadeMap {
  GridPtr map;
  MapRecipe recipe;
  std::shared_ptr<const Molecule> charges{};  ///< in the map's order; null where the map was given
};

/// "pme", "coulomb" or "pb".
std::string to_string(PotentialMethod method);
/// Whether the charges see neither water nor a dielectric.
bool is_vacuum(const MapRecipe& recipe);
/// In a few words, for tables and legends: "vacuum (Coulomb)", "Poisson-Boltzmann, 0.15 mol/l".
std::string potential_label(const MapRecipe& recipe);
/// "bulk solvent", "mean of the cell" or "far away".
std::string to_string(ZeroPlace zero);

/// The parameters that two potentials of one method do not share, with the values of both, "solute dielectric 2 and 4".
std::string differing_parameters(const MapRecipe& source, const MapRecipe& target);

/// What a reader must know of two computed potentials before their difference is believed: charges that do not add up
/// to a whole number, net charges or cells that differ and what that does to the zero, vacuum. Each one sentence.
/// @param source, target null where the side's map was given
std::vector<std::string> potential_notes(const MapRecipe* source, const MapRecipe* target);

}  // namespace espdiff
