// fields.cu: density and distance fields with their gradients.
#include "cuda/deform/fields.h"

#include <cstring>

#include "cuda/surface/mesh/triangle_tree.h"
#include "cuda/surface/sample.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Gradient at a lattice point: central differences, one-sided on the border.
ESPDIFF_INLINE Vec3f lattice_gradient(const CubicLattice& lattice, const float* values, int i, int j, int k) {
  const int at[3] = {i, j, k};
  const std::size_t stride[3] = {1, static_cast<std::size_t>(lattice.size[0]),
                                 static_cast<std::size_t>(lattice.size[0]) * static_cast<std::size_t>(lattice.size[1])};
  const float* const here = values + lattice.index(i, j, k);
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const bool low = at[axis] > 0, high = at[axis] + 1 < lattice.size[axis];
    const float difference = (high ? here[stride[axis]] : *here) - (low ? *(here - stride[axis]) : *here);
    gradient[axis] = difference / (lattice.spacing * (low && high ? 2.0F : 1.0F));
  }
  return gradient;
}

struct SlopeSum {
  double slope = 0, n = 0;
  ESPDIFF_HD SlopeSum& operator+=(const SlopeSum& other) {
    slope += other.slope;
    n += other.n;
    return *this;
  }
};

std::size_t n_rows(const CubicLattice& lattice) {
  return static_cast<std::size_t>(lattice.size[1]) * static_cast<std::size_t>(lattice.size[2]);
}

// Nearest vertices by propagation: a lattice point takes over a neighbour's nearest vertex if that is nearer than its
// own. Rows along each axis are swept in both directions, one thread per row, so the result does not depend on their
// order. After Danielsson's vector distance transform, Comput. Graph. Image Process. 14, 227 (1980).

constexpr std::uint64_t kNoVertex = ~0ULL;
constexpr int kRounds = 2;

/// Squared distance in the high half (positive floats order like integers), vertex in the low half: the smaller key is
/// nearer; ties go to the smaller index.
ESPDIFF_INLINE std::uint64_t vertex_key(float squared_distance, std::uint32_t vertex) {
  std::uint32_t bits;
  std::memcpy(&bits, &squared_distance, sizeof bits);
  return static_cast<std::uint64_t>(bits) << 32 | vertex;
}
ESPDIFF_INLINE std::uint32_t vertex_of(std::uint64_t key) { return static_cast<std::uint32_t>(key); }

ESPDIFF_INLINE float squared_distance(Vec3f a, Vec3f b) { return dot(a - b, a - b); }

/// Offers a vertex to the eight lattice points around it.
ESPDIFF_INLINE void seed_corners(const CubicLattice& lattice, Vec3f p, std::uint32_t vertex, std::uint64_t* keys) {
  const CellPosition at = locate(lattice, p, 0);
  for (int corner = 0; corner < 8; ++corner) {
    const int i = at.base[0] + (corner & 1), j = at.base[1] + (corner >> 1 & 1), k = at.base[2] + (corner >> 2 & 1);
    atomic_minimum(&keys[lattice.index(i, j, k)], vertex_key(squared_distance(lattice.point(i, j, k), p), vertex));
  }
}

/// Sweeps the row of points (start + n * direction) forward and backward.
ESPDIFF_INLINE void sweep_row(const CubicLattice& lattice, const Vec4f* vertices, int axis, int u, int v,
                              std::uint64_t* keys) {
  const int n = lattice.size[axis];
  const auto visit = [&](int at, std::uint64_t carried) {
    int place[3];
    place[axis] = at;
    place[(axis + 1) % 3] = u;
    place[(axis + 2) % 3] = v;
    std::uint64_t& own = keys[lattice.index(place[0], place[1], place[2])];
    if (carried != kNoVertex && vertex_of(carried) != vertex_of(own)) {
      const std::uint32_t vertex = vertex_of(carried);
      const float d = squared_distance(lattice.point(place[0], place[1], place[2]), vertices[vertex].xyz());
      const std::uint64_t candidate = vertex_key(d, vertex);
      if (candidate < own) own = candidate;
    }
    return own;
  };
  std::uint64_t carried = kNoVertex;
  for (int at = 0; at < n; ++at) carried = visit(at, carried);
  for (int at = n - 1; at >= 0; --at) carried = visit(at, carried);
}

/// [point] nearest vertex, as a key.
Buffer<std::uint64_t> nearest_vertices(const CubicLattice& lattice, const SurfaceMesh& surface,
                                       const Progress& progress) {
  Buffer<std::uint64_t> nearest(lattice.n_points(), kNoVertex);
  std::uint64_t* const keys = raw(nearest);
  const Vec4f* const x = raw(surface.positions);
  for_each_index(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    seed_corners(lattice, x[v].xyz(), static_cast<std::uint32_t>(v), keys);
  });
  for (int pass = 0; pass < 3 * kRounds; ++pass) {
    progress.report("distance field", static_cast<double>(pass) / (3 * kRounds));
    const int axis = pass % 3;
    const std::size_t n_u = static_cast<std::size_t>(lattice.size[(axis + 1) % 3]),
                      n_v = static_cast<std::size_t>(lattice.size[(axis + 2) % 3]);
    for_each_index(n_u * n_v, [=] ESPDIFF_HD(std::size_t row) {
      sweep_row(lattice, x, axis, static_cast<int>(row % n_u), static_cast<int>(row / n_u), keys);
    });
  }
  return nearest;
}

/// Distance to the triangles around a vertex.
ESPDIFF_INLINE float distance_to_fan(const TopologyView& topology, const Vec4f* x, std::uint32_t vertex, Vec3f p) {
  float nearest = squared_distance(p, x[vertex].xyz());
  for (std::uint32_t n = topology.first[vertex]; n < topology.first[vertex + 1]; ++n) {
    const Corners& t = topology.triangles[topology.incident[n]];
    nearest = smaller(nearest, squared_distance_to_triangle(p, {x[t.v[0]].xyz(), x[t.v[1]].xyz(), x[t.v[2]].xyz()}));
  }
  return sqrtf(nearest);
}

}  // namespace

float surface_slope(const SurfaceField& density_field, float isovalue) {
  const Vec4f* const values = raw(density_field.values);
  const float near_surface = 0.3F * isovalue;
  const SlopeSum sum = sum_over<SlopeSum>(density_field.values.size(), [=] ESPDIFF_HD(std::size_t point) {
    SlopeSum s;
    if (fabsf(values[point].w) < near_surface) {
      s.slope = static_cast<double>(norm(values[point].xyz()));
      s.n = 1;
    }
    return s;
  });
  return sum.slope > 0 ? static_cast<float>(sum.slope / sum.n) : 1.0F;
}

std::shared_ptr<SurfaceField> density_field(const DensityGrid& density, float isovalue) {
  auto field = std::make_shared<SurfaceField>();
  const CubicLattice lattice = field->lattice = density.lattice;
  require_grid(static_cast<double>(lattice.n_points()), sizeof(Vec4f), "the density field");
  field->values.resize(lattice.n_points());
  const float* const values = raw(density.values);
  Vec4f* const out = raw(field->values);
  for_each_index(n_rows(lattice), [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) {
      const std::size_t point = lattice.index(i, at.j, at.k);
      out[point] = make_vec4(lattice_gradient(lattice, values, i, at.j, at.k), values[point] - isovalue);
    }
  });
  return field;
}

std::shared_ptr<SurfaceField> distance_field(const DensityGrid& density, float isovalue, const SurfaceMesh& surface,
                                             float threshold_A, const Progress& progress) {
  constexpr double kBytesPerPoint = sizeof(Vec4f) + sizeof(std::uint64_t) + sizeof(float);
  require_grid(static_cast<double>(density.lattice.n_points()), kBytesPerPoint, "the distance field");
  std::shared_ptr<SurfaceField> field = density_field(density, isovalue);
  const CubicLattice lattice = field->lattice;
  const Buffer<std::uint64_t> nearest = nearest_vertices(lattice, surface, progress);
  Buffer<float> distances(lattice.n_points());
  const std::uint64_t* const keys = raw(nearest);
  const Vec4f* const x = raw(surface.positions);
  const TopologyView topology = surface.view();
  const float* const values = raw(density.values);
  float* const distance = raw(distances);
  Vec4f* const out = raw(field->values);
  for_each_index(n_rows(lattice), [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) {
      const std::size_t point = lattice.index(i, at.j, at.k);
      const float length = distance_to_fan(topology, x, vertex_of(keys[point]), lattice.point(i, at.j, at.k));
      distance[point] = values[point] > isovalue ? length : -length;
    }
  });
  const float per_slope = 1.0F / surface_slope(*field, isovalue);
  for_each_index(n_rows(lattice), [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) {
      const std::size_t point = lattice.index(i, at.j, at.k);
      // Both parts are lengths; otherwise interpolation across the threshold would overshoot.
      out[point] = fabsf(distance[point]) > threshold_A
                       ? make_vec4(lattice_gradient(lattice, distance, i, at.j, at.k), distance[point])
                       : per_slope * out[point];
    }
  });
  progress.report("distance field", 1.0);
  return field;
}

}  // namespace espdiff::ESPDIFF_BACKEND
