// computed_map.h: potentials that a comparison computes instead of reading them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/molecule/unit_cell.h"
#include "base/types.h"
#include "mapping/input.h"
#include "potential/potential.h"

namespace espdiff {

struct MapRecipe;

/// Surroundings of the charges.
struct ChargeSurroundings {
  std::optional<UnitCell> cell;  ///< the molecule's own, if it has one
  /// Atoms of the solute, in the frame of the charges; bulk solvent is 10 A away from them. Empty: all but water.
  std::vector<Vec3d> solute;
  /// Whether water is among the charges. Needed only if the molecule has no residues.
  bool has_water = false;
};

/// The potential of a molecule's charges, to be sampled at surfaces on the device: by splines of a periodic grid (pme),
/// by those of an isolated one (pb), or summed at the surface's points (coulomb).
///
/// A molecule without a periodic cell is computed along the axes of the comparison's common frame (the source's
/// principal axes). So its orientation in the file changes only rounding.
class ComputedMap {
 public:
  /// @param charges positions and charges of all atoms that count; for pb also radii
  /// @param options superposition and blocks are not used
  /// @throws InputError (no charges, a cell or grid that cannot be, pb with explicit water)
  ComputedMap(Molecule charges, ChargeSurroundings surroundings, const PotentialOptions& options);

  const MapRecipe& recipe() const;
  /// SHA-256 of everything that the map depends on.
  std::string fingerprint() const;
  /// A function that makes the map; it may outlive this object. @throws as the engine's potentials
  MapMaker maker() const;

 private:
  struct Charges;
  std::shared_ptr<const Charges> charges_;
};

/// The mean of a potential over frames, made by PotentialSeries, as the map of one of them. It has no contributions of
/// charges.
/// @param mean kT/e, in the frame's coordinates  @param recipe of the frame's own potential, with n_frames
MapMaker averaged_map(Grid mean, MapRecipe recipe);

}  // namespace espdiff
