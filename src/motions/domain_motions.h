// domain_motions.h: rigid domains in the common frame, and how they move atoms and surfaces before the mapping.
#pragma once

#include <cstdint>
#include <vector>

#include "base/handles.h"
#include "base/molecule/pairing.h"
#include "base/molecule/rigid_domain.h"
#include "base/molecule/screw.h"
#include "base/types.h"

namespace espdiff {

/// The motions of a source's domains. Without domains, everything follows the superposition of the whole.
struct DomainMotions {
  std::vector<RigidTransform> motions;   ///< [domain] from source to target, common frame
  std::vector<Screw> screws;             ///< [domain] the same as screws
  std::vector<std::int32_t> of_residue;  ///< [residue] its domain, -1 for none; empty without domains

  bool none() const { return motions.empty(); }
  /// The motion of a residue; the identity if it is in no domain.
  Screw of(std::int32_t residue) const;
  /// Moves a surface of these atoms with the domains; returns the mesh itself without domains.
  MeshPtr carry(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms) const;
};

/// @param from_source, from_target own frames -> common frame
DomainMotions domain_motions(const std::vector<RigidDomain>& domains, const Molecule& source,
                             const RigidTransform& from_source, const RigidTransform& from_target);

/// The inverse motions: a residue of the target belongs to the domain of its paired source residue.
/// @param source_residue [target residue] from paired_residues(target, source, ...)
DomainMotions inverse(const DomainMotions& motions, const std::vector<std::int32_t>& source_residue);

}  // namespace espdiff
