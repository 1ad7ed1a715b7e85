// earlier_patch.h: a patch of an earlier result's surface, and how its place on another surface was found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A significant patch of an ensemble, on the template of that ensemble.
struct EarlierPatch {
  std::string path, sha256;              ///< of its OUT.json
  std::size_t number = 0;                ///< from 1
  std::vector<Vec3d> positions;          ///< [vertex] of the template
  std::vector<Triangle> triangles;       ///< of the template
  std::vector<std::int32_t> residue;     ///< [vertex] index into `residues`, -1 for none
  std::vector<std::uint8_t> inside;      ///< [vertex] nonzero in the patch
  std::vector<Residue> residues;         ///< of the template
  double area_A2 = 0;                    ///< of the patch
  std::vector<std::string> runs_sha256;  ///< files of the frames in which it was found
};

/// How a patch's place was found; see place_patch().
struct PatchPlacement {
  std::string path, sha256;  ///< of the earlier OUT.json
  std::size_t number = 0;
  double area_A2 = 0;              ///< of the patch on its own template
  std::size_t n_residues = 0;      ///< that were superposed
  std::size_t n_left_out = 0;      ///< residues near the patch that moved too far to be superposed
  double rmsd_A = 0;               ///< of their centres
  double found_area_fraction = 0;  ///< of area_A2: what has a place on the other surface
};

}  // namespace espdiff
