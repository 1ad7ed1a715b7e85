// deform_iteration.h: one iteration of deform() for one vertex.
#pragma once

#include "cuda/deform/deform.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/sample.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Iterations between convergence checks; a check sums over all vertices.
constexpr int kCheckInterval = 5;

/// Input and output of one iteration.
struct Iteration {
  TopologyView topology;
  CubicLattice lattice;
  const Vec4f* field;
  const Vec4f* from;   // [vertex]
  const Vec4f* rest;   // [vertex] L of the rest shape; null for none
  Vec4f* laplacian;    // [vertex] L of `from` minus L of the rest shape
  Vec4f* to;           // [vertex] w: distance moved; before: the positions of the iteration before, at first `from`
  float* path_length;  // [vertex] path length over all iterations
  float* strength;     // [vertex] s: positive while outside, negative while inside, halved at each crossing
  float step_external, step_tension, step_rigidity;  // sigma mu, g sigma (1 - mu)(1 - rho), g sigma (1 - mu) rho
  float momentum;
  bool tricubic;
};

ESPDIFF_INLINE Vec4f field_at(const Iteration& it, Vec3f p) {
  return it.tricubic ? sample_tricubic(it.lattice, it.field, p) : sample_trilinear(it.lattice, it.field, p);
}

ESPDIFF_INLINE void move_vertex(const Iteration& it, std::size_t v) {
  const Vec4f x = it.from[v];
  const Vec4f laplacian = it.laplacian[v];
  const Vec4f laplacian_squared = umbrella(it.topology, it.laplacian, v);
  const Vec3f internal = (it.step_tension * laplacian - it.step_rigidity * laplacian_squared).xyz() +
                         it.momentum * (x.xyz() - it.to[v].xyz());

  const Vec4f sample = field_at(it, x.xyz());
  float s = it.strength[v];
  if ((sample.w > 0) == (s > 0)) {
    s *= -0.5F;
    it.strength[v] = s;
  }
  const float length = norm(sample.xyz());
  Vec3f moved = internal;
  const bool has_neighbours = it.topology.first[v + 1] > it.topology.first[v];
  if (length > 1e-12F && has_neighbours) {
    const Vec3f n = (1.0F / length) * sample.xyz();
    moved = internal + (it.step_external * s - dot(internal, n)) * n;
  }
  const float distance = norm(moved);
  it.path_length[v] += distance;
  it.to[v] = make_vec4(x.xyz() + moved, distance);
}

ESPDIFF_INLINE void take_laplacian(const Iteration& it, std::size_t v) {
  const Vec4f laplacian = umbrella(it.topology, it.from, v);
  it.laplacian[v] = it.rest == nullptr ? laplacian : laplacian - it.rest[v];
}

/// State of the iteration: positions, and a buffer for the next ones.
struct DeformState {
  Iteration iteration{};  ///< all but `from` and `to`
  Buffer<Vec4f> positions, moved;
};

}  // namespace espdiff::ESPDIFF_BACKEND
