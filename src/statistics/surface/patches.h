// patches.h: connected pieces of significant area.
#pragma once

#include <cstdint>
#include <vector>

namespace espdiff {

struct MeshGraph;

/// Connected vertices whose p is at most alpha and whose values have one sign.
struct SignificantPatch {
  std::vector<std::uint32_t> vertices;  ///< rising
  double area = 0;
  std::uint32_t peak = 0;  ///< the vertex of the largest magnitude
};

/// @param p      [vertex]; NaN: not tested
/// @param values [vertex] whose sign separates patches
/// @returns the largest area first; equal areas by their first vertex
std::vector<SignificantPatch> find_patches(const std::vector<double>& p, const std::vector<double>& values,
                                           double alpha, const MeshGraph& graph);

}  // namespace espdiff
