// computed_map.h: potentials that a comparison computes instead of reading them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "base/unit_cell.h"
#include "compare/input.h"
#include "potential/potential.h"

namespace espdiff {

struct MapRecipe;

/// What surrounds the charges.
struct ChargeSurroundings {
  std::optional<UnitCell> cell;  ///< the molecule's own, where it has one
  /// Atoms that bulk solvent keeps 10 A away from, in the frame of the charges; none: all that are not water.
  std::vector<Vec3d> solute;
  /// Whether water is among the charges; where the molecule has residues, they tell.
  bool has_water = false;
};

/// The potential of a molecule's charges, to be sampled at surfaces on the device: by splines of a periodic grid (pme),
/// by those of an isolated one (pb), or summed at the surface's points (coulomb).
///
/// What has no periodic cell of its own is computed along the axes of the comparison's common frame, those of the
/// source itself: how a molecule lies in its file then changes nothing but rounding.
class ComputedMap {
 public:
  /// @param charges positions and charges, for pb radii too; all of them count, whatever part has the surface
  /// @param options superposition and blocks do not count
  /// @throws InputError (no charges, a cell or grid that cannot be, pb with explicit water)
  ComputedMap(Molecule charges, ChargeSurroundings surroundings, const PotentialOptions& options);

  const MapRecipe& recipe() const;
  /// Of all that the map depends on.
  std::string fingerprint() const;
  /// Serves a comparison for as long as it likes, also when this object is gone. @throws as the engine's potentials
  MapMaker maker() const;

 private:
  struct Charges;
  std::shared_ptr<const Charges> charges_;
};

}  // namespace espdiff
