// computed_map.h: potentials that a comparison computes instead of reading them, and how a result tells of them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "compare/input.h"
#include "engine/potential_stage.h"
#include "potential/potential.h"

namespace espdiff {

/// The grid of a computed map where none is asked for. Maps are sampled by their splines, which err no more between the
/// points of 1 A than on them; PMEPot's values (`compatible`) are interpolated linearly, which wants more points.
std::string usual_grid(bool compatible);

/// What a computed map was made of: enough to compute it again.
struct MapRecipe {
  std::string charges_from;  ///< a file, or what VMD calls the molecule
  std::size_t n_charges = 0;
  double net_charge = 0;
  std::string cell_from;  ///< "given", "its own", or "padded"
  PmeCell cell;
  PmeOptions pme;  ///< with the grid's size
};

/// The potential of a molecule's charges by PME, to be sampled at surfaces: on the device, by its splines.
class ComputedMap {
 public:
  /// @param charges  positions and charges; all of them count, whatever part of the molecule has the surface
  /// @param own_cell the molecule's, where it has one
  /// @param options  of method pme; superposition and blocks do not count
  /// @throws InputError (no charges, a cell or grid that cannot be)
  ComputedMap(Molecule charges, const std::optional<UnitCell>& own_cell, const PotentialOptions& options);

  const MapRecipe& recipe() const { return recipe_; }
  /// Of all that the map depends on.
  std::string fingerprint() const;
  /// Serves a comparison for as long as it likes, also when this object is gone. @throws as Engine::pme_potential
  MapMaker maker() const;

 private:
  std::shared_ptr<const Molecule> charges_;
  MapRecipe recipe_;
};

}  // namespace espdiff
