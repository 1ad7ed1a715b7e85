// map_by_deform.h: the method `deform`: field, force iteration, optional subdivision, projection.
#pragma once

#include "base/progress.h"
#include "engine/deform_stage.h"
#include "mapping/build_surface.h"
#include "mapping/mapping.h"
#include "motions/domain_motions.h"

namespace espdiff {

/// The target's field that options.field selects.
/// @param source for two-way gradient vector flow
FieldPtr make_field(Engine& engine, const Surface& source, const Surface& target, const CompareOptions& options,
                    const Progress& progress, VectorFlowReport* report);

/// Deforms a surface onto the target's.
///
/// With options.subdivide, the converged iteration is followed by rounds that split edges longer than a grid spacing
/// and iterate again. A triangle stuck across the mouth of a crevice is thus drawn in by its new vertices, and its
/// neighbours follow. Each round starts with the external force at full strength; otherwise converged vertices would
/// hold back their neighbours. (The thesis proposes this in its section on results.) Each new vertex is traced back to
/// the source: the midpoint of its edge there, projected onto the source's isosurface. It stays in the mesh, so that
/// areas are right and each vertex has a partner; the first vertices are those of `regularized`.
///
/// @param regularized the source's surface; @param start its initial positions, of the same topology
/// @param domains the rigid domains' effect on the shape that the internal force restores
/// @param report  iterations of all rounds, which options.deform.max_iterations limits together, and the last round's
/// displacement
/// @param n_added number of vertices added
/// @return source, mapped and path_length
Mapping map_by_deform(Engine& engine, const Surface& source, const MeshPtr& regularized, const Surface& target,
                      const MeshPtr& start, const DomainMotions& domains, const FieldPtr& field,
                      const CompareOptions& options, const Progress& progress, DeformReport& report,
                      std::size_t& n_added);

}  // namespace espdiff
