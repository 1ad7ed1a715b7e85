// pair_by_place.h: pairs ligands, ions and waters by their places beside the polymer.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "align/pair_residues.h"
#include "base/molecule/pairing.h"

namespace espdiff {

/// Where residues of the source are expected on the target, from paired residues of the polymer.
class PolymerMotion {
 public:
  /// @param polymer (source residue, target residue) of amino acids and nucleotides
  PolymerMotion(const ResidueView& source, const ResidueView& target,
                const std::vector<std::pair<std::size_t, std::size_t>>& polymer);

  /// Whether enough residues pair to tell.
  bool known() const;
  /// A point moved by the superposition of the residues nearest to it; see kNeighbours.
  Vec3d apply(const Vec3d& point) const;

 private:
  std::vector<Vec3d> source_, target_;  ///< [pair] places of the residues
};

/// Pairs residues that are no part of a polymer, of equal names: nearest first, where their centroids are within 4 A
/// after the polymer's motion. Names of chains and numbers do not matter.
/// @param moved receives residues that remain on both sides under one name, each with its nearest such residue; without
/// waters
/// @returns (source residue, target residue)
std::vector<std::pair<std::size_t, std::size_t>> pair_by_place(const ResidueView& source, const ResidueView& target,
                                                               const PolymerMotion& motion,
                                                               std::vector<MovedResidue>& moved);

/// Whether each of these pairs is within the same 4 A.
bool in_place(const ResidueView& source, const ResidueView& target, const PolymerMotion& motion,
              const std::vector<std::pair<std::size_t, std::size_t>>& others);

}  // namespace espdiff
