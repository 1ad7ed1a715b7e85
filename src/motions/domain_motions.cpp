// domain_motions.cpp: domain motions from the molecules' own frames to the common frame, and their inverses.
#include "motions/domain_motions.h"

#include "align/geometry/superpose.h"
#include "engine/engine.h"

namespace espdiff {

Screw DomainMotions::of(std::int32_t residue) const {
  if (residue < 0 || static_cast<std::size_t>(residue) >= of_residue.size()) return {};
  const std::int32_t domain = of_residue[static_cast<std::size_t>(residue)];
  return domain < 0 ? Screw{} : screws[static_cast<std::size_t>(domain)];
}

MeshPtr DomainMotions::carry(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms) const {
  return none() ? mesh : engine.carry_rigidly(mesh, atoms, of_residue, motions);
}

DomainMotions domain_motions(const std::vector<RigidDomain>& domains, const Molecule& source,
                             const RigidTransform& from_source, const RigidTransform& from_target) {
  DomainMotions result;
  if (domains.empty()) return result;
  result.of_residue.assign(source.residues.size(), -1);
  for (const RigidDomain& domain : domains) {
    for (const std::size_t r : domain.residues) result.of_residue[r] = static_cast<std::int32_t>(result.motions.size());
    result.motions.push_back(compose(from_target, compose(domain.motion, inverse(from_source))));
    result.screws.push_back(screw_of(result.motions.back()));
  }
  return result;
}

DomainMotions inverse(const DomainMotions& motions, const std::vector<std::int32_t>& source_residue) {
  DomainMotions result;
  if (motions.none()) return result;
  for (const RigidTransform& motion : motions.motions) result.motions.push_back(inverse(motion));
  // Back along the same way, which may turn by more than 180 degrees.
  for (const Screw& screw : motions.screws)
    result.screws.push_back({screw.axis, screw.through, -screw.angle, -1.0 * screw.shift});
  for (const std::int32_t r : source_residue)
    result.of_residue.push_back(r < 0 ? -1 : motions.of_residue[static_cast<std::size_t>(r)]);
  return result;
}

}  // namespace espdiff
