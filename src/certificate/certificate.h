// certificate.h: whether a comparison is trustworthy, and why not.
#pragma once

#include "base/handles.h"
#include "certificate/result.h"
#include "mapping/mapping.h"

namespace espdiff {

struct CompareResult;
struct MappedSurface;

/// Distances in both directions, intersecting triangles, and the fit of the mapped mesh; no verdict yet.
Certificate certify(Engine& engine, const Mapping& mapping, const MeshPtr& target);

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
/// @param required_share of both surfaces that has to be trusted
void judge(CompareResult& result, const Molecule& source, double required_share);

}  // namespace espdiff
