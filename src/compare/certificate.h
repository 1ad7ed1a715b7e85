// certificate.h: whether a comparison can be trusted, and why not.
#pragma once

#include "compare/mapping.h"
#include "compare/result.h"
#include "engine/handles.h"

namespace espdiff {

struct CompareResult;
struct MappedSurface;

/// Distances both ways, intersecting triangles and the fit of the mapped mesh; not yet judged.
Certificate certify(Engine& engine, const Mapping& mapping, const MeshPtr& target);

/// Share of the area at vertices whose target residue is the one paired with their source residue; NaN where no
/// residues pair.
/// @param source_residue, target_residue [vertex] as Engine::vertex_residues()
/// @param target_of [source residue] as paired_residues()
double same_residue_share(const MappedSurface& surface, const std::vector<std::int32_t>& source_residue,
                          const std::vector<std::int32_t>& target_residue, const std::vector<std::int32_t>& target_of);

/// Fills in trustworthy and reasons.
void judge(Certificate& certificate, const CompareResult& result);

}  // namespace espdiff
