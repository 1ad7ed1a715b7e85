// surroundings.h: how what surrounds a place moves from the source to the target, without what is there itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "align/chain_links.h"
#include "align/pair_residues.h"
#include "certificate/result.h"

namespace espdiff {

/// C-alpha and P atoms of paired residues, in cells.
class Surroundings {
 public:
  /// @param target_of from paired_residues()
  Surroundings(const ResidueView& source, const ResidueView& target, const std::vector<std::int32_t>& target_of);

  /// The superposition of the residues within 13 A of a point of the source, without `skipped`; that of the better 60 %
  /// of them, by three fits, so that a part that moves otherwise does not count. Empty with fewer than 8 residues, and
  /// where the better ones fit by more than 1.5 A: then they do not say where the point belongs.
  std::optional<RigidTransform> motion_around(const Vec3d& point, const std::vector<std::size_t>& skipped = {}) const;

 private:
  using Cell = std::array<int, 3>;
  static Cell cell_of(const Vec3d& p);

  std::vector<Vec3d> source_, target_;  ///< [pair]
  std::vector<std::size_t> residue_;    ///< [pair] of the source
  std::map<Cell, std::vector<std::size_t>> cells_;
};

/// Two molecules with what the checks of their pairs need.
struct PairedMolecules {
  ResidueView source, target;
  std::vector<std::int32_t> target_of, source_of;  ///< paired_residues(), source_residues()
  ChainLinks source_links, target_links;
  Surroundings surroundings;
  /// [source residue] motion_around() its C-alpha or P without the 4 residues on either side along the chain.
  std::vector<std::optional<RigidTransform>> motions;

  PairedMolecules(const Molecule& source, const Molecule& target, const AtomPairing& pairing);
};

}  // namespace espdiff
