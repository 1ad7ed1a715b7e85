// renumbered.cpp: orders of a mesh's vertices.
#include "renumbered.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace espdiff_bench {
namespace {

using espdiff::Mesh;
using espdiff::Triangle;
using espdiff::Vec3f;

/// The mesh with vertex order[i] as its vertex i; triangles by their least vertex.
Mesh in_order(const Mesh& mesh, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> place(order.size());
  Mesh result;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<std::uint32_t>(i);
    result.positions.push_back(mesh.positions[order[i]]);
  }
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  std::sort(result.triangles.begin(), result.triangles.end(), [](const Triangle& a, const Triangle& b) {
    return std::min({a[0], a[1], a[2]}) < std::min({b[0], b[1], b[2]});
  });
  return result;
}

std::uint64_t morton_code(Vec3f p) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::uint64_t>((p[axis] + 512.0F) * 4.0F);
    for (int bit = 0; bit < 16; ++bit) code |= (cell >> bit & 1U) << (3 * bit + axis);
  }
  return code;
}

std::vector<std::uint32_t> all_vertices(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

}  // namespace

Mesh along_a_curve(const Mesh& mesh) {
  std::vector<std::uint32_t> order = all_vertices(mesh);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return morton_code(mesh.positions[a]) < morton_code(mesh.positions[b]);
  });
  return in_order(mesh, order);
}

Mesh shuffled(const Mesh& mesh) {
  std::vector<std::uint32_t> order = all_vertices(mesh);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  return in_order(mesh, order);
}

}  // namespace espdiff_bench
