// renumbered.h: the same mesh with its vertices in another order, to see what their order in memory costs.
#pragma once

#include "base/types.h"

namespace espdiff_bench {

/// Vertices and triangles along the Morton curve: neighbours lie near each other in memory.
espdiff::Mesh along_a_curve(const espdiff::Mesh& mesh);
/// Vertices at random.
espdiff::Mesh shuffled(const espdiff::Mesh& mesh);

}  // namespace espdiff_bench
