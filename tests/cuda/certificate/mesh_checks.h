// mesh_checks.h: invariants of any surface mesh, and hashes to compare results bit by bit.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff_test {

/// Empty if the mesh is a closed, consistently oriented 2-manifold without unused vertices; otherwise the fault.
inline std::string manifold_fault(const espdiff::Mesh& mesh) {
  struct Spoke {
    std::uint32_t to, third;  // the directed edge vertex -> to, and the third vertex of its triangle
  };
  const std::size_t n = mesh.positions.size();
  std::vector<std::size_t> first(n + 1, 0);
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "a triangle names a vertex twice";
    for (const std::uint32_t v : t) {
      if (v >= n) return "a triangle names a vertex that does not exist";
      ++first[v + 1];
    }
  }
  for (std::size_t v = 0; v < n; ++v) first[v + 1] += first[v];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  std::vector<Spoke> spokes(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) spokes[next[t[c]]++] = {t[(c + 1) % 3], t[(c + 2) % 3]};
  }
  const auto count = [&](std::uint32_t v, std::uint32_t to) {
    return std::count_if(&spokes[first[v]], &spokes[first[v]] + (first[v + 1] - first[v]),
                         [&](const Spoke& s) { return s.to == to; });
  };
  for (std::uint32_t v = 0; v < n; ++v) {
    const std::size_t degree = first[v + 1] - first[v];
    if (degree == 0) return "a vertex lies in no triangle";
    const Spoke* const fan = &spokes[first[v]];
    for (std::size_t s = 0; s < degree; ++s) {
      if (count(v, fan[s].to) != 1) return "a directed edge lies in two triangles";
      if (count(fan[s].to, v) != 1) return "an edge has no opposite";
    }
    std::size_t n_walked = 0;
    std::uint32_t at = fan[0].to;
    do {
      const Spoke* const spoke = std::find_if(fan, fan + degree, [&](const Spoke& s) { return s.to == at; });
      at = spoke->third;
      ++n_walked;
    } while (at != fan[0].to && n_walked < degree);
    if (n_walked != degree || at != fan[0].to) return "the triangles around a vertex form more than one fan";
  }
  return "";
}

/// V - E + F; every edge of a closed mesh lies in two triangles.
inline long euler_characteristic(const espdiff::Mesh& mesh) {
  return static_cast<long>(mesh.positions.size()) - static_cast<long>(mesh.triangles.size()) / 2;
}

inline double signed_volume(const espdiff::Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int c) { return static_cast<espdiff::Vec3d>(mesh.positions[t[static_cast<std::size_t>(c)]]); };
    sum += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return sum;
}

/// [vertex] component in the order of their first vertex, by union-find.
inline std::vector<std::uint32_t> components_oracle(const espdiff::Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) parent[std::max(root(t[0]), root(v))] = std::min(root(t[0]), root(v));
  }
  std::vector<std::uint32_t> label(parent.size());
  std::uint32_t n = 0;
  for (std::uint32_t v = 0; v < label.size(); ++v) label[v] = root(v) == v ? n++ : label[root(v)];
  return label;
}

/// FNV-1a over the bits of the values added.
class Hash {
 public:
  template <typename T>
  Hash& add(const T& value) {
    static_assert(std::is_arithmetic_v<T>, "padding has no defined bits");
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) state_ = (state_ ^ byte) * 1099511628211ULL;
    return *this;
  }
  template <typename T>
  Hash& add(const espdiff::Vec3<T>& v) {
    return add(v.x).add(v.y).add(v.z);
  }
  template <typename T>
  Hash& add(const std::vector<T>& values) {
    for (const T& value : values) add(value);
    return add(values.size());
  }
  Hash& add(const espdiff::Triangle& t) { return add(t[0]).add(t[1]).add(t[2]); }
  Hash& add(const espdiff::Mesh& mesh) {
    return add(mesh.positions).add(mesh.normals).add(mesh.triangles).add(mesh.component);
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace espdiff_test
