// renumbered.h: the same mesh with its vertices in another order, to measure the cost of memory order.
#pragma once

#include "base/types.h"

namespace espdiff_bench {

/// Vertices and triangles along the Morton curve: neighbours are close in memory.
espdiff::Mesh along_a_curve(const espdiff::Mesh& mesh);
/// Vertices in random order.
espdiff::Mesh shuffled(const espdiff::Mesh& mesh);

}  // namespace espdiff_bench
