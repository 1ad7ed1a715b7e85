// side_chains.h: other places of side chains that a structure does not know well, on a grid of their dihedral angles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "causes/causes.h"

namespace espdiff {

/// The places of one residue's side chain in one state. Placement 0 is the file's.
struct SideChainPlacements {
  std::size_t change = 0;                     ///< index into Causes::changes
  std::vector<std::size_t> atoms;             ///< that move: indices into the molecule
  std::vector<std::vector<Vec3d>> positions;  ///< [placement][atom of `atoms`], the molecule's frame
  std::vector<std::vector<double>> angles;    ///< [placement][dihedral angle] degrees
  std::size_t n_refused = 0;                  ///< of the grid: they clash with what stays in place
};

/// Heavy atoms of different residues nearer than this clash; nitrogen, oxygen and sulphur may be nearer (hydrogen
/// bonds).
constexpr double kClash_A = 3.0, kPolarClash_A = 2.5;

/// The residues of one state whose side chains may lie otherwise: their place is poorly known there, or they turned,
/// and at least one other placement on the grid clashes with nothing that stays in place. The grid: -60, 60 and 180
/// degrees about bonds of two tetrahedral atoms; steps of 60 degrees where the last atom is planar (half of them where
/// half a turn exchanges equal atoms); -90, 90 and 180 about CD-NE of arginine. Bond lengths and angles are kept;
/// hydrogens turn along. Proline, cystine's and what lacks atoms stay in place.
/// @param of_target     which state of `changes` the molecule is
/// @param may_move      [change] nonzero for residues at the surface
/// @param charges       [atom] of the molecule; residues whose atoms that move bear none are left out
std::vector<SideChainPlacements> side_chain_placements(const Molecule& molecule,
                                                       const std::vector<ResidueChange>& changes, bool of_target,
                                                       const std::vector<std::uint8_t>& may_move,
                                                       const std::vector<float>& charges);

/// [draw][side chain] a placement of each, drawn evenly from its own, one after the other: a side chain that would
/// clash with one before it takes another placement, or the file's where all clash. Reproducible: a function of seed,
/// state and number of the draw.
std::vector<std::vector<std::size_t>> draw_placements(const Molecule& molecule,
                                                      const std::vector<SideChainPlacements>& side_chains,
                                                      std::size_t n_draws, std::uint64_t seed, bool of_target);

}  // namespace espdiff
