// map_by_deform.h: the method `deform`: field, force iteration, temporary subdivision, projection.
#pragma once

#include "base/progress.h"
#include "compare/build_surface.h"
#include "compare/domain_motions.h"
#include "compare/mapping.h"

namespace espdiff {

/// The target's field, as options.field says.
/// @param source for two-way gradient vector flow
FieldPtr make_field(Engine& engine, const Surface& source, const Surface& target, const CompareOptions& options,
                    const Progress& progress, VectorFlowReport* report);

/// Deforms a surface onto the target's.
///
/// With options.subdivide, edges that have grown longer than a grid spacing when the iteration has come to rest are
/// halved and it goes on, round after round: where a triangle is stuck across the mouth of a crevice its new vertices
/// are drawn in, and their neighbours after them. Each round begins with the external force at full strength: a vertex
/// that has come to rest would else hold back those beside it. (The thesis proposes it, in its section on results.) A
/// new vertex is traced back to the source: it comes from the middle of its edge there, moved onto the source's
/// isosurface. It stays in the mesh, so that areas are right and each vertex has its counterpart; the first vertices
/// are those of `regularized`.
///
/// @param regularized the source's surface; @param start where it starts, of the same topology
/// @param domains what rigid domains do to the shape that the internal force restores
/// @param report  iterations of all rounds, which options.deform.max_iterations limits together, and the last one's
/// displacement
/// @param n_added vertices
/// @return source, mapped and path_length
Mapping map_by_deform(Engine& engine, const Surface& source, const MeshPtr& regularized, const Surface& target,
                      const MeshPtr& start, const DomainMotions& domains, const FieldPtr& field,
                      const CompareOptions& options, const Progress& progress, DeformReport& report,
                      std::size_t& n_added);

}  // namespace espdiff
