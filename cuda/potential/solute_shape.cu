// solute_shape.cu: which points of a lattice lie in the solute: by points (device), by planes (CPU).
#include <algorithm>
#include <cmath>

#include "cuda/potential/dielectric_map.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// What kernels see of a shape.
struct ShapeView {
  ProbeAtomsView atoms;
  AtomCellsView probes;
  float probe;
  bool has_probe, has_arcs;

  ESPDIFF_INLINE float atom_radius(std::uint32_t a) const { return atoms.radius[a] - probe; }
};

ESPDIFF_INLINE float square_of(float dx, float dy, float dz) { return dx * dx + dy * dy + dz * dz; }

/// Whether the probe may stand where p, inside the enlarged sphere of atom a, is projected to.
ESPDIFF_INLINE bool is_reached_on(const ShapeView& shape, std::uint32_t a, Vec3f p, float square) {
  const Vec3f centre = shape.atoms.centre(a);
  const float scale = shape.atoms.radius[a] / sqrtf(square);
  return !shape.atoms.is_buried(a, centre + scale * (p - centre));
}

ESPDIFF_INLINE std::uint8_t state_of(const ShapeView& shape, Vec3f p) {
  std::uint8_t state = kSolvent;
  visit_atom_runs(shape.atoms.cells, p, shape.atoms.cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t a = begin; a < end; ++a) {
      const float square = square_of(p.x - shape.atoms.cells.x[a], p.y - shape.atoms.cells.y[a], p.z - shape.atoms.cells.z[a]);
      const float inner = shape.atom_radius(a), outer = shape.atoms.radius[a];
      if (square < inner * inner) {
        state = kSolute;
      } else if (square < outer * outer && state == kSolvent) {
        state = kWithinProbe;
      }
    }
  });
  if (state != kWithinProbe || !shape.has_probe) return state;
  visit_atom_runs(shape.atoms.cells, p, shape.atoms.cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t a = begin; a < end && state == kWithinProbe; ++a) {
      if (shape.atoms.exposed[a] == 0) continue;
      const float square = square_of(p.x - shape.atoms.cells.x[a], p.y - shape.atoms.cells.y[a], p.z - shape.atoms.cells.z[a]);
      if (square < shape.atoms.radius[a] * shape.atoms.radius[a] && is_reached_on(shape, a, p, square)) state = kSolvent;
    }
  });
  if (state != kWithinProbe || !shape.has_arcs) return state;
  visit_atom_runs(shape.probes, p, shape.probe, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t c = begin; c < end; ++c) {
      if (square_of(p.x - shape.probes.x[c], p.y - shape.probes.y[c], p.z - shape.probes.z[c]) < shape.probe * shape.probe)
        state = kSolvent;
    }
  });
  return state;
}

#if !defined(ESPDIFF_BACKEND_CUDA)

/// The points of a plane within a distance of a centre, row by row: visit(first point's index, j, first i, end i).
template <typename Visit>
ESPDIFF_INLINE void visit_disc(const CubicLattice& lattice, int k, Vec3f centre, float radius, Visit visit) {
  const float dz = lattice.coordinate(2, k) - centre.z, reach = radius * radius - dz * dz;
  if (!(reach > 0)) return;
  const float disc = sqrtf(reach), inverse = 1.0F / lattice.spacing;
  const int j0 = std::max(0, static_cast<int>((centre.y - disc - lattice.origin.y) * inverse)),
            j1 = std::min(lattice.size[1] - 1, static_cast<int>((centre.y + disc - lattice.origin.y) * inverse) + 1);
  for (int j = j0; j <= j1; ++j) {
    const float dy = lattice.coordinate(1, j) - centre.y, left = reach - dy * dy;
    if (!(left > 0)) continue;
    const float half = sqrtf(left);
    // A point more on each side: the visit's own test decides.
    const int i0 = std::max(0, static_cast<int>((centre.x - half - lattice.origin.x) * inverse)),
              i1 = std::min(lattice.size[0] - 1, static_cast<int>((centre.x + half - lattice.origin.x) * inverse) + 1);
    visit(j, i0, i1 + 1, dy, dz);
  }
}

struct PlaneFill {
  ShapeView shape;
  CubicLattice lattice;
  std::size_t n_atoms;
  const std::uint32_t* first_probe;  ///< [plane + 1] of `probes` that reach it
  const std::uint32_t* probes;
  std::uint8_t* states;
};

/// Marks what lies in atoms and in their enlarged spheres.
ESPDIFF_INLINE void mark_spheres(const PlaneFill& in, int k) {
  const AtomCellsView& cells = in.shape.atoms.cells;
  const float z = in.lattice.coordinate(2, k);
  for (std::uint32_t a = 0; a < in.n_atoms; ++a) {
    const float outer = in.shape.atoms.radius[a], inner = in.shape.atom_radius(a);
    if (fabsf(cells.z[a] - z) >= outer) continue;
    const float outer2 = outer * outer, inner2 = inner * inner, x = cells.x[a];
    visit_disc(in.lattice, k, in.shape.atoms.centre(a), outer,
               [&](int j, int i0, int i1, float dy, float dz) ESPDIFF_INLINE_LAMBDA {
                 std::uint8_t* const row = in.states + in.lattice.index(0, j, k);
                 for (int i = i0; i < i1; ++i) {
                   const float square = square_of(in.lattice.coordinate(0, i) - x, dy, dz);
                   const std::uint8_t state = square < inner2 ? kSolute : square < outer2 ? kWithinProbe : kSolvent;
                   row[i] = row[i] > state ? row[i] : state;
                 }
               });
  }
}

/// Gives back to the solvent what a probe reaches that touches one atom.
ESPDIFF_INLINE void reach_faces(const PlaneFill& in, int k) {
  const AtomCellsView& cells = in.shape.atoms.cells;
  const float z = in.lattice.coordinate(2, k);
  for (std::uint32_t a = 0; a < in.n_atoms; ++a) {
    const float outer = in.shape.atoms.radius[a], outer2 = outer * outer, x = cells.x[a];
    if (in.shape.atoms.exposed[a] == 0 || fabsf(cells.z[a] - z) >= outer) continue;
    visit_disc(in.lattice, k, in.shape.atoms.centre(a), outer, [&](int j, int i0, int i1, float dy, float dz) {
      std::uint8_t* const row = in.states + in.lattice.index(0, j, k);
      for (int i = i0; i < i1; ++i) {
        if (row[i] != kWithinProbe) continue;
        const Vec3f p = in.lattice.point(i, j, k);
        const float square = square_of(p.x - x, dy, dz);
        if (square < outer2 && is_reached_on(in.shape, a, p, square)) row[i] = kSolvent;
      }
    });
  }
}

/// Gives back what a probe reaches that touches two or more.
ESPDIFF_INLINE void reach_arcs(const PlaneFill& in, int k) {
  const float probe2 = in.shape.probe * in.shape.probe;
  for (std::uint32_t n = in.first_probe[k]; n < in.first_probe[k + 1]; ++n) {
    const std::uint32_t c = in.probes[n];
    const Vec3f centre{in.shape.probes.x[c], in.shape.probes.y[c], in.shape.probes.z[c]};
    visit_disc(in.lattice, k, centre, in.shape.probe,
               [&](int j, int i0, int i1, float dy, float dz) ESPDIFF_INLINE_LAMBDA {
                 std::uint8_t* const row = in.states + in.lattice.index(0, j, k);
                 for (int i = i0; i < i1; ++i) {
                   const bool reached = square_of(in.lattice.coordinate(0, i) - centre.x, dy, dz) < probe2;
                   row[i] = reached && row[i] == kWithinProbe ? kSolvent : row[i];
                 }
               });
  }
}

ESPDIFF_MULTIVERSION void fill_plane(const PlaneFill& in, int k) {
  const std::size_t plane = in.lattice.index(0, 0, 1);
  std::uint8_t* const states = in.states + plane * static_cast<std::size_t>(k);
  for (std::size_t i = 0; i < plane; ++i) states[i] = kSolvent;
  mark_spheres(in, k);
  if (!in.shape.has_probe) return;
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

void SoluteShape::states(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const {
#if defined(ESPDIFF_BACKEND_CUDA)
  states_by_points(lattice, states);
#else
  states_by_planes(lattice, states);
#endif
}

void SoluteShape::states_by_points(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const {
  const ShapeView shape{view_of(atoms_), probes_ ? probes_->view() : AtomCellsView{}, probe_, probe_ > 0, probes_ != nullptr};
  states.resize(lattice.n_points());
  std::uint8_t* const out = raw(states);
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  for_each_index(states.size(), [=] ESPDIFF_HD(std::size_t p) {
    out[p] = state_of(shape, lattice.point(static_cast<int>(p % nx), static_cast<int>(p / nx % ny),
                                           static_cast<int>(p / (nx * ny))));
  });
}

#if !defined(ESPDIFF_BACKEND_CUDA)
void SoluteShape::states_by_planes(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const {
  states.resize(lattice.n_points());
  PlaneFill fill{{view_of(atoms_), probes_ ? probes_->view() : AtomCellsView{}, probe_, probe_ > 0, probes_ != nullptr},
                 lattice,
                 atoms_.radius.size(),
                 nullptr,
                 nullptr,
                 raw(states)};
  // Probes by the planes that they reach.
  std::vector<std::uint32_t> first(static_cast<std::size_t>(lattice.size[2]) + 1, 0), probes;
  const std::size_t n_probes = probes_ ? probes_->x.size() : 0;
  const auto planes_of = [&](std::size_t c) {
    const float z = raw(probes_->z)[c] - lattice.origin.z;
    const int low = static_cast<int>(std::ceil((z - probe_) / lattice.spacing)),
              high = static_cast<int>(std::floor((z + probe_) / lattice.spacing));
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
    for (int k = planes[0]; k <= planes[1]; ++k) probes[next[static_cast<std::size_t>(k)]++] = static_cast<std::uint32_t>(c);
  }
  fill.first_probe = first.data();
  fill.probes = probes.data();
  for_each_index(static_cast<std::size_t>(lattice.size[2]), [=](std::size_t k) { fill_plane(fill, static_cast<int>(k)); });
}
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
