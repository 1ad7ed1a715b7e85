// domain_motions.h: rigid domains in the common frame, and what they do to atoms and surfaces before the mapping.
#pragma once

#include <cstdint>
#include <vector>

#include "align/rigid_domains.h"
#include "compare/build_surface.h"

namespace espdiff {

/// The motions of a source's domains. Without domains everything keeps to the superposition of the whole.
struct DomainMotions {
  std::vector<RigidTransform> motions;   ///< [domain] from the source's place to the target's, common frame
  std::vector<Screw> screws;             ///< [domain] the same
  std::vector<std::int32_t> of_residue;  ///< [residue] its domain, -1 for none; empty where there are no domains

  bool none() const { return motions.empty(); }
  /// The motion of a residue; none where it is in no domain.
  Screw of(std::int32_t residue) const;
  /// Where the motions take a surface of these atoms: the mesh itself without domains.
  MeshPtr carry(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms) const;
};

/// @param from_source, from_target own frames -> common frame
DomainMotions domain_motions(const std::vector<RigidDomain>& domains, const Molecule& source,
                             const RigidTransform& from_source, const RigidTransform& from_target);

/// The way back: a residue of the target belongs to the domain of the source's residue that it is paired with.
/// @param source_residue [target residue] as paired_residues(target, source, ...) gives it
DomainMotions inverse(const DomainMotions& motions, const std::vector<std::int32_t>& source_residue);

}  // namespace espdiff
