// place_patch.h: finds the place of an earlier result's patch on another surface.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"

namespace espdiff {

struct EarlierPatch;
struct PatchPlacement;

/// A surface whose vertices belong to residues.
struct ResidueSurface {
  const std::vector<Vec3d>& positions;
  const std::vector<Triangle>& triangles;
  const std::vector<std::int32_t>& residue;  ///< [vertex] index into `residues`, -1 for none
  const std::vector<Residue>& residues;
};

/// A patch on another surface.
struct PlacedPatch {
  std::vector<std::uint8_t> inside;  ///< [vertex] nonzero in the patch
  std::shared_ptr<const PatchPlacement> placement;
};

/// Farther from the moved patch no vertex belongs to it: there the next residue begins.
constexpr double kPatchReach_A = 3;
/// A patch of which less was found is no longer that patch.
constexpr double kLeastFoundArea = 0.5;

/// Residues are paired by pair_residues(). Those within 10 A of the patch, at least six, are superposed by the centres
/// of their surfaces, so that the patch follows its surroundings and not the whole molecule; residues that end farther
/// than 3 A from their partners are dropped, one after the other, as long as half of them stay (the pruning of
/// Meng et al., BMC Bioinformatics 7, 339 (2006)). A vertex belongs to the patch if the nearest vertex of the moved
/// template does, and lies within kPatchReach_A. The patch's area is found where the nearest vertex of the surface
/// belongs to the patch.
/// @throws InputError (fewer than three residues near the patch pair)
PlacedPatch place_patch(const EarlierPatch& patch, const ResidueSurface& surface, const std::string& surface_name);

/// [residue] nonzero where at least half of its surface is in the patch; where no residue has as much, the one that has
/// most of the patch.
std::vector<std::uint8_t> residues_in_patch(const std::vector<std::uint8_t>& inside, const ResidueSurface& surface);

}  // namespace espdiff
