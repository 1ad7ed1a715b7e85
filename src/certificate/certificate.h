// certificate.h: whether a comparison is trustworthy, and why not.
#pragma once

#include "base/handles.h"
#include "certificate/result.h"
#include "mapping/mapping.h"

namespace espdiff {

struct MappedSurface;

/// Distances in both directions, intersecting triangles, and the fit of the mapped mesh, of a whole mapping or a part
/// of it (part_of_mapping()); no verdict yet. What nothing was mapped for is NaN, since zeros would flatter.
/// @param target  the surface that the mapping is to cover; null where the part has none
/// @param reached the matched surface from which the target's distances are measured: the whole mapping's
Certificate certify(Engine& engine, const Mapping& mapping, const MeshPtr& target, const MeshPtr& reached);

/// Fraction of the area at vertices whose target residue is paired with their source residue; NaN if no residues pair.
/// @param source_residue, target_residue [vertex] from Engine::vertex_residues()
/// @param target_of [source residue] from paired_residues()
double same_residue_share(const MappedSurface& surface, const SurfaceAreas& areas,
                          const std::vector<std::int32_t>& source_residue,
                          const std::vector<std::int32_t>& target_residue, const std::vector<std::int32_t>& target_of);

/// Why the fit of the mapped surface makes a result untrustworthy: corrupt, flipped and intersecting area, distances.
std::vector<Message> fit_reasons(const Certificate& certificate);
/// Whether so much is unmatched that another mapping may do better; see choose_motions.h.
std::vector<Message> unmatched_reasons(const Certificate& certificate);

/// Sets the certificate's `trustworthy` and `reasons`, from its trusted area among others.
/// @param warnings of the inputs; those that refuse are reasons
/// @param required_share of both surfaces that has to be trusted
void judge(MeasuredSurface& surface, const std::vector<Warning>& warnings, const Molecule& source,
           double required_share);

}  // namespace espdiff
