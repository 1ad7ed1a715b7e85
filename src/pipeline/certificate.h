// certificate.h: whether a comparison can be trusted, and why not.
#pragma once

#include "pipeline/compare.h"
#include "pipeline/mapping.h"

namespace espdiff {

/// Distances both ways, intersecting triangles and the fit of the mapped mesh; not yet judged.
Certificate certify(Engine& engine, const Mapping& mapping, const MeshPtr& target);

/// Fills in trustworthy and reasons.
void judge(Certificate& certificate, const CompareResult& result);

}  // namespace espdiff
