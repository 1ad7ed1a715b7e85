// solute_shape.cu: which points of a lattice lie in the solute: by points (device), by planes (CPU).
#include <algorithm>
#include <cmath>

#include "cuda/potential/pb/dielectric_map.h"

#if !defined(ESPDIFF_BACKEND_CUDA)
#include <omp.h>
#endif

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A shape for kernels.
struct ShapeView {
  ProbeAtomsView atoms;
  AtomCellsView probes;
  float probe;
  float reach;   ///< probe radius and a lattice step: farther probes do not matter next to the surface
  float margin;  ///< distance beyond the enlarged spheres within which depths are computed
  bool has_probe, has_arcs;

  /// Otherwise it matters of points whether they are in an enlarged sphere, but not how deep.
  ESPDIFF_INLINE bool needs_depth_outside() const { return !has_probe || margin > 0.0F; }
};

ESPDIFF_INLINE float square_of(float dx, float dy, float dz) { return dx * dx + dy * dy + dz * dz; }

/// Deeper points are not examined.
constexpr float kDeepest_A = 1000;

/// Whether the probe fits at the projection of p, at distance d from atom a, onto the enlarged sphere.
/// @param likely see ProbeAtomsView::is_buried()
ESPDIFF_INLINE bool is_reached_on(const ShapeView& shape, std::uint32_t a, Vec3f p, float d, std::uint32_t& likely) {
  const Vec3f centre = shape.atoms.centre(a);
  const float scale = shape.atoms.radius[a] / d;
  return !shape.atoms.is_buried(a, centre + scale * (p - centre), likely);
}

ESPDIFF_INLINE float depth_at(const ShapeView& shape, Vec3f p) {
  const AtomCellsView& cells = shape.atoms.cells;
  float inside = -kDeepest_A;
  visit_atom_runs(cells, p, cells.max_reach + shape.margin, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t a = begin; a < end; ++a) {
      const float square = square_of(p.x - cells.x[a], p.y - cells.y[a], p.z - cells.z[a]),
                  radius = shape.atoms.radius[a];
      inside = shape.needs_depth_outside() ? larger(inside, radius - sqrtf(square))
               : square < radius * radius  ? 1.0F
                                           : inside;
    }
  });
  // Beyond the margin the value does not matter.
  if (inside <= 0.0F || !shape.has_probe) return inside < -shape.margin ? -kDeepest_A : inside - shape.probe;
  float depth = kDeepest_A;
  visit_atom_runs(cells, p, cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t a = begin; a < end; ++a) {
      if (shape.atoms.exposed[a] == 0) continue;
      const float d = sqrtf(square_of(p.x - cells.x[a], p.y - cells.y[a], p.z - cells.z[a]));
      const float by_atom = shape.atoms.radius[a] - d;
      if (!(by_atom > 0.0F && by_atom < shape.reach)) continue;
      std::uint32_t likely = shape.atoms.first[a];
      if (by_atom - shape.probe < depth && is_reached_on(shape, a, p, d, likely)) depth = by_atom - shape.probe;
    }
  });
  if (!shape.has_arcs) return depth;
  visit_atom_runs(shape.probes, p, shape.reach, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t c = begin; c < end; ++c) {
      const float d = sqrtf(square_of(p.x - shape.probes.x[c], p.y - shape.probes.y[c], p.z - shape.probes.z[c]));
      if (d < shape.reach) depth = smaller(depth, d - shape.probe);
    }
  });
  return depth;
}

#if !defined(ESPDIFF_BACKEND_CUDA)

constexpr int kRowLanes = 16;

/// The points of a plane within a distance of a centre, and points beside them: rows in stretches of kRowLanes points,
/// or of all points of shorter rows. Calls of_stretch(first i) and then, for its rows, of_row(first i, first point's
/// index in the plane, dy, dz).
template <typename OfStretch, typename OfRow>
ESPDIFF_INLINE void visit_disc(const CubicLattice& lattice, int k, Vec3f centre, float radius, OfStretch of_stretch,
                               OfRow of_row) {
  const float dz = lattice.coordinate(2, k) - centre.z, reach = radius * radius - dz * dz,
              inverse = 1 / lattice.spacing;
  if (!(reach > 0)) return;
  const float disc = sqrtf(reach);
  const auto below = [=](int axis) {
    return std::max(0, static_cast<int>((centre[axis] - disc - lattice.origin[axis]) * inverse));
  };
  const auto above = [=](int axis) {
    const int last = static_cast<int>((centre[axis] + disc - lattice.origin[axis]) * inverse) + 1;
    return std::min(lattice.size[axis] - 1, last);
  };
  const int i1 = above(0), j0 = below(1), j1 = above(1), last = lattice.size[0] - std::min(kRowLanes, lattice.size[0]);
  for (int i = below(0); i <= i1; i += kRowLanes) {
    const int first = std::min(i, last);
    of_stretch(first);
    for (int j = j0; j <= j1; ++j) of_row(first, lattice.index(first, j, 0), lattice.coordinate(1, j) - centre.y, dz);
  }
}

/// Of the points of visit_disc(), renews the values: value = merge(value, square of the distance from the centre).
template <typename Merge>
ESPDIFF_INLINE void merge_squares(const CubicLattice& of, int k, Vec3f centre, float radius, float* plane,
                                  Merge merge) {
  const CubicLattice lattice = of;  // a copy, which the plane's values cannot change
  const int n = std::min(kRowLanes, lattice.size[0]);
  float squares[kRowLanes];
  visit_disc(
      lattice, k, centre, radius,
      [&](int first) ESPDIFF_INLINE_LAMBDA {
        for (int lane = 0; lane < kRowLanes; ++lane) {
          const float dx = lattice.coordinate(0, first + lane) - centre.x;
          squares[lane] = dx * dx;
        }
      },
      [&](int, std::size_t index, float dy, float dz) ESPDIFF_INLINE_LAMBDA {
        float* const row = plane + index;
        const auto renew = [&](int lane) ESPDIFF_INLINE_LAMBDA {
          row[lane] = merge(row[lane], squares[lane] + dy * dy + dz * dz);
        };
        if (n == kRowLanes) {
#pragma omp simd
          for (int lane = 0; lane < kRowLanes; ++lane) renew(lane);
        } else {
          for (int lane = 0; lane < n; ++lane) renew(lane);
        }
      });
}

struct PlaneFill {
  ShapeView shape;
  CubicLattice lattice;
  std::size_t n_atoms;
  const std::uint32_t* first_probe;  ///< [plane + 1] of `probes` that reach it
  const std::uint32_t* probes;
  float* depths;
  float* squares;  ///< [point of a plane] for each thread: of distances from the nearest probe
};

/// Depth of points in the enlarged spheres, or the greatest depth if it does not matter.
ESPDIFF_INLINE void mark_spheres(const PlaneFill& in, int k) {
  const AtomCellsView& cells = in.shape.atoms.cells;
  const float z = in.lattice.coordinate(2, k);
  const bool needs_depth = in.shape.needs_depth_outside();
  float* const plane = in.depths + in.lattice.index(0, 0, k);
  for (std::uint32_t a = 0; a < in.n_atoms; ++a) {
    const float radius = in.shape.atoms.radius[a], reach = radius + in.shape.margin;
    if (fabsf(cells.z[a] - z) >= reach) continue;
    if (needs_depth) {
      merge_squares(in.lattice, k, in.shape.atoms.centre(a), reach, plane,
                    [=](float before, float square)
                        ESPDIFF_INLINE_LAMBDA { return larger(before, radius - sqrtf(square)); });
    } else {
      merge_squares(in.lattice, k, in.shape.atoms.centre(a), reach, plane,
                    [=](float before, float square)
                        ESPDIFF_INLINE_LAMBDA { return square < radius * radius ? kDeepest_A : before; });
    }
  }
}

/// Points of a stretch, projected onto the enlarged sphere of an atom.
struct ProjectedPoints {
  float x[kRowLanes], y[kRowLanes], z[kRowLanes], depth[kRowLanes];
  int is_free[kRowLanes];  ///< -1 where the probe may fit, and brings the point less deep than it was

  /// @param before the depths so far, of `n` points
  ESPDIFF_INLINE ProjectedPoints(const ShapeView& shape, const CubicLattice& lattice, Vec3f centre, float radius,
                                 int first, float dy, float dz, const float* before, int n) {
    const float probe = shape.probe, reach = shape.reach;
    float depth_before[kRowLanes];
    if (n == kRowLanes) {
      for (int lane = 0; lane < kRowLanes; ++lane) depth_before[lane] = before[lane];
    } else {
      for (int lane = 0; lane < kRowLanes; ++lane) depth_before[lane] = lane < n ? before[lane] : -kDeepest_A;
    }
#pragma omp simd
    for (int lane = 0; lane < kRowLanes; ++lane) {
      const float dx = lattice.coordinate(0, first + lane) - centre.x, d = sqrtf(square_of(dx, dy, dz)),
                  by_atom = radius - d, scale = radius / d;
      x[lane] = centre.x + scale * dx;
      y[lane] = centre.y + scale * dy;
      z[lane] = centre.z + scale * dz;
      depth[lane] = by_atom - probe;
      const bool matters = (by_atom > 0.0F) & (by_atom < reach) & (depth[lane] < depth_before[lane]);
      is_free[lane] = matters ? -1 : 0;
    }
  }
  /// Takes the points within the enlarged sphere of atom b.
  ESPDIFF_INLINE void take(const ProbeAtomsView& atoms, std::uint32_t b) {
    const Vec3f centre = atoms.centre(b);
    const float square = atoms.radius[b] * atoms.radius[b] * kNotQuite;
#pragma omp simd
    for (int lane = 0; lane < kRowLanes; ++lane) {
      const float covered = square_of(x[lane] - centre.x, y[lane] - centre.y, z[lane] - centre.z);
      is_free[lane] = covered < square ? 0 : is_free[lane];
    }
  }
  ESPDIFF_INLINE bool any_free() const {
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int lane = 0; lane < kRowLanes; ++lane) any |= is_free[lane];
    return any != 0;
  }
};

/// Points that a probe covers while it touches one atom.
ESPDIFF_INLINE void reach_faces(const PlaneFill& in, int k) {
  const CubicLattice lattice = in.lattice;
  const ProbeAtomsView atoms = in.shape.atoms;
  const float z = lattice.coordinate(2, k);
  const int n = std::min(kRowLanes, lattice.size[0]);
  float* const plane = in.depths + lattice.index(0, 0, k);
  for (std::uint32_t a = 0; a < in.n_atoms; ++a) {
    const float radius = atoms.radius[a];
    if (atoms.exposed[a] == 0 || fabsf(atoms.cells.z[a] - z) >= radius) continue;
    const Vec3f centre = atoms.centre(a);
    const std::uint32_t begin = atoms.first[a], end = atoms.first[a + 1];
    std::uint32_t likely = begin;  // the neighbour that took points of the row before
    const auto of_row = [&](int first, std::size_t index, float dy, float dz) ESPDIFF_INLINE_LAMBDA {
      float* const row = plane + index;
      ProjectedPoints points(in.shape, lattice, centre, radius, first, dy, dz, row, n);
      if (!points.any_free()) return;
      if (begin < end) {
        points.take(atoms, atoms.neighbour[likely]);
        for (std::uint32_t b = begin; b < end; ++b) {
          if (!points.any_free()) return;
          likely = b;
          points.take(atoms, atoms.neighbour[b]);
        }
      }
      for (int lane = 0; lane < n; ++lane) row[lane] = points.is_free[lane] != 0 ? points.depth[lane] : row[lane];
    };
    visit_disc(
        lattice, k, centre, radius, [](int) {}, of_row);
  }
}

/// Points that a probe covers while it touches two or more: squared distances from the nearest one first.
ESPDIFF_INLINE void reach_arcs(const PlaneFill& in, int k) {
  const float probe = in.shape.probe, reach = in.shape.reach;
  const CubicLattice lattice = in.lattice;
  const std::size_t plane = lattice.index(0, 0, 1);
  float* const squares = in.squares + plane * static_cast<std::size_t>(omp_get_thread_num());
  for (std::size_t i = 0; i < plane; ++i) squares[i] = INFINITY;
  for (std::uint32_t n = in.first_probe[k]; n < in.first_probe[k + 1]; ++n) {
    const std::uint32_t c = in.probes[n];
    const Vec3f centre{in.shape.probes.x[c], in.shape.probes.y[c], in.shape.probes.z[c]};
    merge_squares(lattice, k, centre, reach, squares,
                  [=](float before, float square) ESPDIFF_INLINE_LAMBDA { return smaller(square, before); });
  }
  float* const depths = in.depths + plane * static_cast<std::size_t>(k);
  for (std::size_t i = 0; i < plane; ++i) {
    const float d = sqrtf(squares[i]), before = depths[i];
    const bool covers = (d < reach) & (before > -probe);
    depths[i] = covers ? smaller(before, d - probe) : before;
  }
}

ESPDIFF_MULTIVERSION void fill_plane(const PlaneFill& in, int k) {
  const std::size_t plane = in.lattice.index(0, 0, 1);
  float* const depths = in.depths + plane * static_cast<std::size_t>(k);
  for (std::size_t i = 0; i < plane; ++i) depths[i] = -kDeepest_A;
  mark_spheres(in, k);
  if (in.shape.needs_depth_outside()) {
    const bool has_probe = in.shape.has_probe;
    const float margin = -in.shape.margin, probe = in.shape.probe;
    for (std::size_t i = 0; i < plane; ++i) {
      const float outside = depths[i] < margin ? -kDeepest_A : depths[i] - probe;
      depths[i] = depths[i] > 0.0F && has_probe ? kDeepest_A : outside;
    }
    if (!has_probe) return;
  }
  reach_faces(in, k);
  reach_arcs(in, k);
}

#endif

}  // namespace

SoluteShape::SoluteShape(const std::vector<PbAtom>& atoms, float probe_radius) : probe_(probe_radius) {
  atoms_ = make_probe_atoms(atoms, probe_radius);
  if (!(probe_radius > 0)) return;
  const Buffer<Vec4f> probes = find_probe_positions(atoms_);
  if (probes.empty()) return;
  std::vector<Vec3d> positions;
  for (const Vec4f& p : to_host(probes)) positions.push_back(static_cast<Vec3d>(p.xyz()));
  probes_ = make_atom_cells(positions, std::vector<float>(positions.size(), probe_radius / kCutoffInWidths),
                            std::vector<std::int32_t>(positions.size(), 0));
}

void SoluteShape::depths(const CubicLattice& lattice, Buffer<float>& depths) const {
#if defined(ESPDIFF_BACKEND_CUDA)
  depths_by_points(lattice, depths);
#else
  depths_by_planes(lattice, depths);
#endif
}

namespace {

ShapeView view_of(const ProbeAtoms& atoms, const std::shared_ptr<AtomCells>& probes, float probe, float spacing) {
  return {view_of(atoms),   probes ? probes->view() : AtomCellsView{}, probe,
          probe + spacing,  probe < spacing ? spacing - probe : 0.0F,  probe > 0,
          probes != nullptr};
}

}  // namespace

void SoluteShape::depths_by_points(const CubicLattice& lattice, Buffer<float>& depths) const {
  const ShapeView shape = view_of(atoms_, probes_, probe_, lattice.spacing);
  depths.resize(lattice.n_points());
  float* const out = raw(depths);
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  for_each_index(depths.size(), [=] ESPDIFF_HD(std::size_t p) {
    out[p] = depth_at(
        shape, lattice.point(static_cast<int>(p % nx), static_cast<int>(p / nx % ny), static_cast<int>(p / (nx * ny))));
  });
}

#if !defined(ESPDIFF_BACKEND_CUDA)
void SoluteShape::depths_by_planes(const CubicLattice& lattice, Buffer<float>& depths) const {
  depths.resize(lattice.n_points());
  Buffer<float> squares(lattice.index(0, 0, 1) * static_cast<std::size_t>(omp_get_max_threads()));
  PlaneFill fill{view_of(atoms_, probes_, probe_, lattice.spacing),
                 lattice,
                 atoms_.radius.size(),
                 nullptr,
                 nullptr,
                 raw(depths),
                 raw(squares)};
  // Probes sorted by plane.
  std::vector<std::uint32_t> first(static_cast<std::size_t>(lattice.size[2]) + 1, 0), probes;
  const std::size_t n_probes = probes_ ? probes_->n_atoms() : 0;
  const auto planes_of = [&](std::size_t c) {
    const float z = raw(probes_->z)[c] - lattice.origin.z;
    const int low = static_cast<int>(std::ceil((z - fill.shape.reach) / lattice.spacing)),
              high = static_cast<int>(std::floor((z + fill.shape.reach) / lattice.spacing));
    return std::array<int, 2>{std::max(0, low), std::min(lattice.size[2] - 1, high)};
  };
  for (std::size_t c = 0; c < n_probes; ++c) {
    const std::array<int, 2> planes = planes_of(c);
    for (int k = planes[0]; k <= planes[1]; ++k) ++first[static_cast<std::size_t>(k) + 1];
  }
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  probes.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t c = 0; c < n_probes; ++c) {
    const std::array<int, 2> planes = planes_of(c);
    for (int k = planes[0]; k <= planes[1]; ++k)
      probes[next[static_cast<std::size_t>(k)]++] = static_cast<std::uint32_t>(c);
  }
  fill.first_probe = first.data();
  fill.probes = probes.data();
  for_each_index(static_cast<std::size_t>(lattice.size[2]),
                 [=](std::size_t k) { fill_plane(fill, static_cast<int>(k)); });
}
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
