// split_edges.cu: numbers the new vertices and the new triangles by prefix sums, then writes them.
#include "cuda/surface/mesh/split_edges.h"

#include <utility>

#include "cuda/surface/mesh/adjacency.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

/// Place of the edge between two vertices in the row of the smaller vertex.
ESPDIFF_INLINE std::uint32_t edge_place(const TopologyView& topology, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t low = a < b ? a : b, high = a < b ? b : a;
  for (std::uint32_t p = topology.first[low]; p < topology.first[low + 1]; ++p) {
    if (topology.neighbour[p] == high) return p;
  }
  return kNone;
}

/// The new vertices on a triangle's edges, edge c from corner c to the next; kNone for an edge that is not split.
struct Halves {
  std::uint32_t middle[3];
  int n;
};

struct Division {
  TopologyView topology;
  const std::uint32_t* marked;
  const std::uint32_t* number;  // [place] index among the new vertices, where marked
  const std::uint8_t* splits;   // [vertex] whether any edge of its row is marked
  std::uint32_t n_old;
};

ESPDIFF_INLINE Halves halves_of(const Division& in, const Corners& corners) {
  Halves halves{{kNone, kNone, kNone}, 0};
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t a = corners.v[c], b = corners.v[(c + 1) % 3];
    if (in.splits[a < b ? a : b] == 0) continue;
    const std::uint32_t place = edge_place(in.topology, a, b);
    if (place == kNone || in.marked[place] == 0) continue;
    halves.middle[c] = in.n_old + in.number[place];
    ++halves.n;
  }
  return halves;
}

/// Writes the parts of a triangle.
ESPDIFF_INLINE void divide(const Corners& t, const Halves& halves, const Vec4f* x, Corners* out) {
  if (halves.n == 0) {
    out[0] = t;
    return;
  }
  if (halves.n == 3) {
    const std::uint32_t* m = halves.middle;
    out[0] = {{t.v[0], m[0], m[2]}};
    out[1] = {{m[0], t.v[1], m[1]}};
    out[2] = {{m[2], m[1], t.v[2]}};
    out[3] = {{m[0], m[1], m[2]}};
    return;
  }
  // Rotated so that edge 0 is split; if two edges are split, edge 2 is the whole one.
  int turn = 0;
  for (int c = 0; c < 3; ++c) {
    const bool whole_before = halves.middle[(c + 2) % 3] == kNone;
    if (halves.middle[c] != kNone && whole_before) turn = c;
  }
  const std::uint32_t a = t.v[turn], b = t.v[(turn + 1) % 3], c = t.v[(turn + 2) % 3];
  const std::uint32_t ab = halves.middle[turn];
  if (halves.n == 1) {
    out[0] = {{a, ab, c}};
    out[1] = {{ab, b, c}};
    return;
  }
  const std::uint32_t bc = halves.middle[(turn + 1) % 3];
  out[0] = {{ab, b, bc}};
  // The quadrangle a, ab, bc, c. New vertices have no position yet; use the midpoints.
  const Vec3f middle_ab = 0.5F * (x[a].xyz() + x[b].xyz()), middle_bc = 0.5F * (x[b].xyz() + x[c].xyz());
  const Vec3f first = x[a].xyz() - middle_bc, second = middle_ab - x[c].xyz();
  if (dot(first, first) <= dot(second, second)) {
    out[1] = {{a, ab, bc}};
    out[2] = {{a, bc, c}};
  } else {
    out[1] = {{a, ab, c}};
    out[2] = {{ab, bc, c}};
  }
}

}  // namespace

EdgeSplit split_edges(const Topology& topology, const Buffer<std::uint32_t>& marked, const Buffer<Vec4f>& positions) {
  const std::size_t n_vertices = topology.n_vertices, n_triangles = topology.triangles.size();
  const TopologyView view{n_vertices,
                          n_triangles,
                          raw(topology.triangles),
                          raw(topology.first),
                          raw(topology.neighbour),
                          raw(topology.incident)};
  Buffer<std::uint32_t> numbers(3 * n_triangles);
  std::uint32_t* const number = raw(numbers);
  Buffer<std::uint8_t> splitting(n_vertices);
  std::uint8_t* const splits = raw(splitting);
  const std::uint32_t* const mark = raw(marked);
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    std::uint32_t any = 0;
    for (std::uint32_t p = view.first[v]; p < view.first[v + 1]; ++p) {
      number[p] = mark[p] != 0 && v < view.neighbour[p] ? 1U : 0U;
      any |= number[p];
    }
    splits[v] = static_cast<std::uint8_t>(any);
  });
  const Division division{view, mark, number, splits, static_cast<std::uint32_t>(n_vertices)};
  Buffer<std::uint32_t> begins(n_triangles);
  std::uint32_t* const begin = raw(begins);
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    begin[t] = 1U + static_cast<std::uint32_t>(halves_of(division, view.triangles[t]).n);
  });
  HostReads totals;
  ScanTotal<std::uint32_t> new_vertices(numbers, totals), parts_of_all(begins, totals);
  totals.wait();
  const std::uint32_t n_new = new_vertices.get(), n_parts = parts_of_all.get();

  EdgeSplit split;
  split.ends.resize(n_new);
  EdgeSplit::Ends* const ends = raw(split.ends);
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    if (splits[v] == 0) return;
    for (std::uint32_t p = view.first[v]; p < view.first[v + 1]; ++p) {
      if (mark[p] != 0 && v < view.neighbour[p]) ends[number[p]] = {static_cast<std::uint32_t>(v), view.neighbour[p]};
    }
  });
  Buffer<Corners> parts(n_parts);
  split.parent.resize(n_parts);
  Corners* const part = raw(parts);
  std::uint32_t* const parent = raw(split.parent);
  const Vec4f* const x = raw(positions);
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    const Halves halves = halves_of(division, view.triangles[t]);
    divide(view.triangles[t], halves, x, part + begin[t]);
    for (int k = 0; k <= halves.n; ++k)
      parent[begin[t] + static_cast<std::uint32_t>(k)] = static_cast<std::uint32_t>(t);
  });
  split.topology = make_topology(n_vertices + n_new, std::move(parts));
  return split;
}

}  // namespace espdiff::ESPDIFF_BACKEND
