// domain_motions.h: rigid pieces in the common frame, and what they do to atoms and surfaces before the mapping.
#pragma once

#include <cstdint>
#include <vector>

#include "align/rigid_domains.h"
#include "compare/build_surface.h"

namespace espdiff {

/// The motions of a source's pieces. Without pieces everything keeps to the superposition of the whole.
struct PieceMotions {
  std::vector<RigidTransform> motions;   ///< [piece] from the source's place to the target's, common frame
  std::vector<Screw> screws;             ///< [piece] the same
  std::vector<std::int32_t> of_residue;  ///< [residue] its piece, -1 for none; empty where there are no pieces

  bool none() const { return motions.empty(); }
  /// The motion of a residue; none where it is in no piece.
  Screw of(std::int32_t residue) const;
  /// Where the motions take a surface of these atoms: the mesh itself without pieces.
  MeshPtr carry(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms) const;
};

/// @param from_source, from_target own frames -> common frame
PieceMotions piece_motions(const std::vector<RigidPiece>& pieces, const Molecule& source,
                           const RigidTransform& from_source, const RigidTransform& from_target);

/// The way back: a residue of the target belongs to the piece of the source's residue that it is paired with.
/// @param source_residue [target residue] as paired_residues(target, source, ...) gives it
PieceMotions inverse(const PieceMotions& motions, const std::vector<std::int32_t>& source_residue);

}  // namespace espdiff
