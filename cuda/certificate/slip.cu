// slip.cu: how far mapped points are from where the atoms at their source carried them.
#include "cuda/certificate/slip.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cuda/certificate/metrics.h"
#include "cuda/surface/point_sums.h"
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
  std::vector<std::uint32_t> order;
  Carriers all;
  all.cells = make_atom_cells(positions, widths, pairs, &order);
  std::vector<Motion> sorted;
  for (const std::uint32_t atom : order) sorted.push_back(motions[atom]);
  all.motions = to_device(sorted);
  return all;
}

/// The vertices of the target's surface by the pair that owns them: row k holds those of pair k.
struct OwnedPlaces {
  Buffer<std::uint32_t> first;   ///< [pair + 1]
  Buffer<std::uint32_t> vertex;  ///< [place]
};

OwnedPlaces owned_places(const SurfaceMesh& target, const std::vector<MovingAtom>& atoms) {
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
  const std::vector<std::int32_t> owner = to_host(vertex_residues(target, *make_atom_cells(positions, widths, pairs)));
  std::vector<std::uint32_t> first(static_cast<std::size_t>(last) + 2, 0), vertex;
  for (const std::int32_t pair : owner) {
    if (pair >= 0) ++first[static_cast<std::size_t>(pair) + 1];
  }
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  vertex.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end());
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (owner[v] >= 0) vertex[next[static_cast<std::size_t>(owner[v])]++] = static_cast<std::uint32_t>(v);
  }
  return {to_device(first), to_device(vertex)};
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

}  // namespace

std::vector<float> slip(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                        const std::vector<MovingAtom>& atoms) {
  if (source.n_vertices() != mapped.n_vertices()) throw GeometryError("slip: the meshes differ in topology");
  const Carriers carried_by = carriers(atoms);
  const OwnedPlaces places = owned_places(target, atoms);
  const AtomCellsView cells = carried_by.cells->view();
  const Motion* const motion = raw(carried_by.motions);
  const std::uint32_t *const first = raw(places.first), *const place = raw(places.vertex);
  const TopologyView target_topology = target.view();
  const Vec4f *const from = raw(source.positions), *const to = raw(mapped.positions), *const x = raw(target.positions);
  Buffer<float> slips(source.n_vertices());
  float* const result = raw(slips);
  for_each_index(source.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec3f p = from[v].xyz();
    Vec3f sum{};
    float all = 0.0F, paired = 0.0F;
    sum_at_point(cells, p,
                 [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
                   all += gaussian;
                   if (cells.residue[a] < 0) return;
                   paired += gaussian;
                   sum += gaussian * motion[a].at(p);
                 });
    result[v] = NAN;
    if (!(paired > (1.0F - kMostUnpaired) * all)) return;
    const Vec3f carried = (1.0F / paired) * sum;
    // The nearest place that the partners own.
    float least = INFINITY;
    std::uint32_t nearest = 0;
    sum_at_point(cells, p,
                 [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
                   const std::int32_t pair = cells.residue[a];
                   if (pair < 0 || gaussian < kLeastShare * all) return;
                   for (std::uint32_t k = first[pair]; k < first[pair + 1]; ++k) {
                     const Vec3f d = x[place[k]].xyz() - carried;
                     const float square = dot(d, d);
                     if (square < least || (square == least && place[k] < nearest)) {
                       least = square;
                       nearest = place[k];
                     }
                   }
                 });
    // Partners that are buried own no place; then the point belongs where it was carried.
    const Vec3f there = least < INFINITY ? nearest_around(target_topology, x, nearest, carried) : carried;
    result[v] = norm(to[v].xyz() - there);
  });
  return to_host(slips);
}

}  // namespace espdiff::ESPDIFF_BACKEND
