// slip.cu: how far mapped points are from where the atoms at their source carried them.
#include "cuda/certificate/slip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "cuda/device/sort.h"
#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/point_sums.h"
#include "cuda/surface/density/vertex_residues.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// An atom with a smaller share of the density at a point does not say where the point belongs.
constexpr float kLeastShare = 0.05F;
/// Where atoms without a partner make more of the density than this, nothing says where the point belongs.
constexpr float kMostUnpaired = 0.5F;

/// A rigid motion: x -> row x + shift.
struct Motion {
  Vec3f row[3];
  Vec3f shift;

  ESPDIFF_INLINE Vec3f at(Vec3f p) const { return Vec3f{dot(row[0], p), dot(row[1], p), dot(row[2], p)} + shift; }
};

Vec3d rotated(Vec3d v, Vec3d rotation) {
  const double angle = norm(rotation);
  if (angle == 0) return v;
  Screw turn;
  turn.axis = (1 / angle) * rotation;
  turn.angle = angle;
  return turn.turn(v, 1);
}

/// From the start of an atom's path to its end, with the rotation of its surroundings.
Motion motion_of(const MovingAtom& atom) {
  Motion motion{};
  Vec3d rotated_start{};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d unit{};
    unit[axis] = 1;
    const Vec3d column = atom.motion.turn(rotated(unit, atom.own_rotation), 1);
    for (int row = 0; row < 3; ++row) motion.row[row][axis] = static_cast<float>(column[row]);
    rotated_start += atom.start[axis] * column;
  }
  motion.shift = static_cast<Vec3f>(atom.end - rotated_start);
  return motion;
}

/// The source's atoms in cells, labelled with their pairs, and their motions in the cells' order.
struct Carriers {
  std::shared_ptr<AtomCells> cells;
  Buffer<Motion> motions;
};

Carriers carriers(const std::vector<MovingAtom>& atoms) {
  std::vector<Vec3d> positions;
  std::vector<float> widths;
  std::vector<std::int32_t> pairs;
  std::vector<Motion> motions;
  for (const MovingAtom& atom : atoms) {
    if (!atom.at_start) continue;
    positions.push_back(atom.start);
    widths.push_back(static_cast<float>(atom.start_width));
    pairs.push_back(atom.pair);
    motions.push_back(motion_of(atom));
  }
  Buffer<std::uint32_t> order;
  Carriers all;
  all.cells = make_atom_cells(positions, widths, pairs, &order);
  all.motions = in_cell_order(motions, order);
  return all;
}

/// The vertices of the target's surface by the pair that owns them: row k holds those of pair k.
Rows owned_places(const SurfaceMesh& target, const std::vector<MovingAtom>& atoms) {
  std::vector<Vec3d> positions;
  std::vector<float> widths;
  std::vector<std::int32_t> pairs;
  std::int32_t last = -1;
  for (const MovingAtom& atom : atoms) {
    last = std::max(last, atom.pair);
    if (!atom.at_end) continue;
    positions.push_back(atom.end);
    widths.push_back(static_cast<float>(atom.end_width));
    pairs.push_back(atom.pair);
  }
  const Buffer<std::int32_t> owners = vertex_residues(target, *make_atom_cells(positions, widths, pairs));
  const std::uint32_t n_pairs = static_cast<std::uint32_t>(last + 1);
  Buffer<std::uint32_t> rows(owners.size());
  const std::int32_t* const owner = raw(owners);
  std::uint32_t* const row = raw(rows);
  for_each_index(rows.size(), [=] ESPDIFF_HD(std::size_t v) {
    row[v] = owner[v] >= 0 ? static_cast<std::uint32_t>(owner[v]) : n_pairs;
  });
  return sort_into_rows(std::move(rows), n_pairs);
}

ESPDIFF_INLINE Vec3f nearest_on_segment(Vec3f p, Vec3f a, Vec3f b) {
  const Vec3f ab = b - a;
  const float square = dot(ab, ab);
  const float t = square > 0 ? smaller(larger(dot(p - a, ab) / square, 0.0F), 1.0F) : 0.0F;
  return a + t * ab;
}

/// Of two points the nearer one to p, the first on ties.
ESPDIFF_INLINE Vec3f nearer(Vec3f p, Vec3f a, Vec3f b) { return dot(p - b, p - b) < dot(p - a, p - a) ? b : a; }

/// The foot of p on the plane if it falls into the triangle, otherwise the nearest point of the three edges.
ESPDIFF_INLINE Vec3f nearest_on_triangle(Vec3f p, Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f n = cross(b - a, c - a);
  const float nn = dot(n, n);
  if (nn > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0)
    return p - (dot(p - a, n) / nn) * n;
  return nearer(p, nearest_on_segment(p, a, b), nearer(p, nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)));
}

/// The nearest point of the triangles around a vertex.
ESPDIFF_INLINE Vec3f nearest_around(const TopologyView& topology, const Vec4f* x, std::uint32_t vertex, Vec3f p) {
  Vec3f best = x[vertex].xyz();
  for (std::uint32_t k = topology.first[vertex]; k < topology.first[vertex + 1]; ++k) {
    const Corners c = topology.triangles[topology.incident[k]];
    best = nearer(p, best, nearest_on_triangle(p, x[c.v[0]].xyz(), x[c.v[1]].xyz(), x[c.v[2]].xyz()));
  }
  return best;
}

/// What the slip of a vertex is made from.
struct SlipInputs {
  AtomCellsView cells;
  const Motion* motion;        ///< [sorted atom]
  const std::uint32_t* first;  ///< [pair + 1]
  const std::uint32_t* place;  ///< vertices of the target
  TopologyView target;
  const Vec4f *from, *to, *there;  ///< source, mapped, target
  PointList points;                ///< of the source, in spatial order
  float* slip;
};

/// Where the atoms carried a point, and the vertex of the target that their partners own nearest to it.
struct Carried {
  Vec3f to;
  float square;  ///< infinite if the partners are buried and own no vertex
  std::uint32_t vertex;
};

ESPDIFF_INLINE float slip_from(const SlipInputs& in, std::size_t v, const Carried& carried) {
  // Then the point belongs where it was carried.
  const Vec3f there =
      carried.square < INFINITY ? nearest_around(in.target, in.there, carried.vertex, carried.to) : carried.to;
  return norm(in.to[v].xyz() - there);
}

ESPDIFF_INLINE float slip_at(const SlipInputs& in, std::size_t v) {
  const Vec3f p = in.from[v].xyz();
  Vec3f sum{};
  float all = 0.0F, paired = 0.0F;
  sum_at_point(in.cells, p,
               [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
                 all += gaussian;
                 if (in.cells.residue[a] < 0) return;
                 paired += gaussian;
                 sum += gaussian * in.motion[a].at(p);
               });
  if (!(paired > (1.0F - kMostUnpaired) * all)) return NAN;
  Carried carried{(1.0F / paired) * sum, INFINITY, 0};
  sum_at_point(in.cells, p,
               [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
                 const std::int32_t pair = in.cells.residue[a];
                 if (pair < 0 || gaussian < kLeastShare * all) return;
                 for (std::uint32_t k = in.first[pair]; k < in.first[pair + 1]; ++k) {
                   const Vec3f d = in.there[in.place[k]].xyz() - carried.to;
                   const float square = dot(d, d);
                   if (square < carried.square || (square == carried.square && in.place[k] < carried.vertex)) {
                     carried.square = square;
                     carried.vertex = in.place[k];
                   }
                 }
               });
  return slip_from(in, v, carried);
}

#if !defined(__CUDACC__)

/// Paired atoms that reach a block; in a block with more, its vertices are taken one by one.
constexpr std::size_t kMostAtoms = 512;

template <typename Numbers>
struct CarriedLanes {
  Numbers x, y, z, square;
  MaskOf<Numbers> vertex;
};

/// The nearest of a pair's places, in lanes in which the pair's atom has its share.
template <typename Numbers>
ESPDIFF_INLINE void visit_places(const SlipInputs& in, std::int32_t pair, const Numbers& gaussian, const Numbers& least,
                                 CarriedLanes<Numbers>& c) {
  using Vertices = MaskOf<Numbers>;
  for (std::uint32_t k = in.first[pair]; k < in.first[pair + 1]; ++k) {
    const std::uint32_t vertex = in.place[k];
    const Vec4f& x = in.there[vertex];
    const Numbers dx = x.x - c.x, dy = x.y - c.y, dz = x.z - c.z;
    const Numbers square =
        chosen<Vertices, Numbers>(gaussian < least, Numbers{} + INFINITY, dx * dx + dy * dy + dz * dz);
    const Vertices own = Vertices{} + static_cast<std::int32_t>(vertex);
    const Vertices of_equal = smaller_lanes(own, c.vertex);
    c.vertex = chosen(square == c.square, of_equal, chosen(square < c.square, own, c.vertex));
    c.square = smaller_lanes(square, c.square);
  }
}

template <std::size_t N>
ESPDIFF_INLINE void slip_of_block(const SlipInputs& in, const SharedAtoms& near, std::size_t begin) {
  using Numbers = typename LaneTypes<N>::Numbers;
  std::int32_t pairs[kMostAtoms];
  Numbers gaussians[kMostAtoms];
  std::size_t n = 0;
  const PointList& list = in.points;
  const std::size_t end = std::min(begin + N, list.n);
  Numbers px, py, pz;
  for (std::size_t lane = 0; lane < N; ++lane) {
    const Vec4f& p = list.points[list.list[std::min(begin + lane, end - 1)]];
    px[lane] = p.x;
    py[lane] = p.y;
    pz[lane] = p.z;
  }
  Numbers all{}, paired{}, x{}, y{}, z{};
  sum_at_block<N>(in.cells, near, list, begin,
                  [&](std::uint32_t a, float, const Numbers&, const Numbers&, const Numbers&, const Numbers&,
                      const Numbers& gaussian) ESPDIFF_INLINE_LAMBDA {
                    all += gaussian;
                    if (in.cells.residue[a] < 0) return;
                    paired += gaussian;
                    const Motion& m = in.motion[a];
                    x += gaussian * ((m.row[0].x * px + m.row[0].y * py + m.row[0].z * pz) + m.shift.x);
                    y += gaussian * ((m.row[1].x * px + m.row[1].y * py + m.row[1].z * pz) + m.shift.y);
                    z += gaussian * ((m.row[2].x * px + m.row[2].y * py + m.row[2].z * pz) + m.shift.z);
                    if (n < kMostAtoms) {
                      pairs[n] = in.cells.residue[a];
                      gaussians[n] = gaussian;
                    }
                    ++n;
                  });
  const Numbers inverse = 1.0F / paired;
  CarriedLanes<Numbers> carried{inverse * x, inverse * y, inverse * z, Numbers{} + INFINITY, {}};
  const Numbers least = kLeastShare * all;
  for (std::size_t k = 0; k < std::min(n, kMostAtoms); ++k) {
    if (any_lane(gaussians[k] >= least)) visit_places(in, pairs[k], gaussians[k], least, carried);
  }
  for (std::size_t lane = 0; begin + lane < end; ++lane) {
    const std::uint32_t v = list.list[begin + lane];
    const Carried one{{carried.x[lane], carried.y[lane], carried.z[lane]},
                      carried.square[lane],
                      static_cast<std::uint32_t>(carried.vertex[lane])};
    if (n > kMostAtoms) {
      in.slip[v] = slip_at(in, v);
    } else {
      in.slip[v] = paired[lane] > (1.0F - kMostUnpaired) * all[lane] ? slip_from(in, v, one) : NAN;
    }
  }
}

template <std::size_t N>
ESPDIFF_INLINE void slip_of_points(const SlipInputs& in, std::size_t begin, std::size_t end) {
  SharedAtoms near;
  near.find<N>(in.cells, in.points, begin, end);
  for (std::size_t block = begin; block < end; block += N) slip_of_block<N>(in, near, block);
}

ESPDIFF_NARROW_VERSION void slip_narrow(const SlipInputs& in, std::size_t begin, std::size_t end) {
  slip_of_points<kBlock>(in, begin, end);
}
ESPDIFF_WIDE_VERSION void slip_wide(const SlipInputs& in, std::size_t begin, std::size_t end) {
  slip_of_points<kWideBlock>(in, begin, end);
}

#endif

void by_points(const SlipInputs& in, std::size_t n) {
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { in.slip[v] = slip_at(in, v); });
}

/// @param by_blocks  whether the CPU goes through blocks of neighbouring vertices
std::vector<float> slip_in_form(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                                const std::vector<MovingAtom>& atoms, bool by_blocks) {
  if (source.n_vertices() != mapped.n_vertices()) throw GeometryError("slip: the meshes differ in topology");
  const std::size_t n = source.n_vertices();
  const Carriers carried_by = carriers(atoms);
  const Rows places = owned_places(target, atoms);
  Buffer<float> slips(n);
  SlipInputs in{carried_by.cells->view(),
                raw(carried_by.motions),
                raw(places.first),
                raw(places.item),
                target.view(),
                raw(source.positions),
                raw(mapped.positions),
                raw(target.positions),
                {},
                raw(slips)};
#if defined(__CUDACC__)
  static_cast<void>(by_blocks);
  by_points(in, n);
#else
  if (by_blocks) {
    const Buffer<std::uint32_t> order = spatial_order(source.positions);
    in.points = {raw(source.positions), raw(order), n};
    for_all_blocks(n, in, slip_narrow, slip_wide);
  } else {
    by_points(in, n);
  }
#endif
  return to_host(slips);
}

}  // namespace

std::vector<float> slip(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                        const std::vector<MovingAtom>& atoms) {
  return slip_in_form(source, mapped, target, atoms, true);
}

std::vector<float> slip_point_by_point(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                                       const std::vector<MovingAtom>& atoms) {
  return slip_in_form(source, mapped, target, atoms, false);
}

}  // namespace espdiff::ESPDIFF_BACKEND
