// probe_positions.cu: neighbours whose spheres intersect, the exposed arcs of their circles, points on the arcs.
#include "cuda/potential/probe_positions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cuda/device/angles.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Distance d between points of an arc. The surface is off by (d / 2)^2 / (2 probe radius).
constexpr float kArcSpacing_A = 0.2F;
constexpr float kTwoPi = 6.28318531F;
constexpr int kMostArcs = 24;

ESPDIFF_INLINE float squared_distance(const AtomCellsView& cells, std::uint32_t a, std::uint32_t b) {
  const float dx = cells.x[b] - cells.x[a], dy = cells.y[b] - cells.y[a], dz = cells.z[b] - cells.z[a];
  return dx * dx + dy * dy + dz * dz;
}

#if defined(ESPDIFF_BACKEND_CUDA)

/// The atom whose neighbour list has the entry.
ESPDIFF_INLINE std::uint32_t owner_of(const std::uint32_t* first, std::uint32_t n_atoms, std::uint32_t entry) {
  std::uint32_t low = 0, high = n_atoms;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    if (first[middle] <= entry) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Sorts each atom's list, nearest first; neighbours at the same distance keep their order. A thread for each entry
/// counts those before it.
void sort_nearest_first(const AtomCellsView& cells, std::uint32_t n_atoms, const std::uint32_t* first,
                        Buffer<std::uint32_t>& list) {
  Buffer<std::uint32_t> sorted(list.size());
  const std::uint32_t* const from = raw(list);
  std::uint32_t* const to = raw(sorted);
  for_each_index(list.size(), [=] ESPDIFF_HD(std::size_t index) {
    const std::uint32_t entry = static_cast<std::uint32_t>(index), a = owner_of(first, n_atoms, entry);
    const float square = squared_distance(cells, a, from[entry]);
    std::uint32_t rank = 0;
    for (std::uint32_t other = first[a]; other < first[a + 1]; ++other) {
      const float of_other = squared_distance(cells, a, from[other]);
      if (of_other < square || (of_other == square && other < entry)) ++rank;
    }
    to[first[a] + rank] = from[entry];
  });
  list.swap(sorted);
}

#else

/// The same on the CPU, by a thread for each atom; among equal distances in the order of the atoms.
void sort_nearest_first(const AtomCellsView& cells, std::uint32_t n_atoms, const std::uint32_t* first,
                        Buffer<std::uint32_t>& list) {
  std::uint32_t* const item = raw(list);
  for_each_index(n_atoms, [=](std::size_t a) {
    constexpr std::uint32_t kUsual = 256;
    std::uint32_t* const own = item + first[a];
    const std::uint32_t n = first[a + 1] - first[a];
    const auto with_distance = [&](std::uint32_t b) {
      return std::pair(squared_distance(cells, static_cast<std::uint32_t>(a), b), b);
    };
    if (n > kUsual) {
      std::sort(own, own + n, [&](std::uint32_t b, std::uint32_t c) { return with_distance(b) < with_distance(c); });
      return;
    }
    std::pair<float, std::uint32_t> sorted[kUsual];
    for (std::uint32_t i = 0; i < n; ++i) sorted[i] = with_distance(own[i]);
    std::sort(sorted, sorted + n);
    for (std::uint32_t i = 0; i < n; ++i) own[i] = sorted[i].second;
  });
}

#endif

/// Nearest first, because they cover most.
void find_neighbours(ProbeAtoms& atoms, float max_radius) {
  const AtomCellsView cells = atoms.cells->view();
  const float* const radius = raw(atoms.radius);
  const std::size_t n = atoms.radius.size();
  atoms.first.resize(n + 1, 0);
  std::uint32_t* const first = raw(atoms.first);
  const auto visit_neighbours = [=] ESPDIFF_HD(std::uint32_t a, std::uint32_t * out) {
    const Vec3f p{cells.x[a], cells.y[a], cells.z[a]};
    std::uint32_t found = 0;
    visit_atom_runs(cells, p, radius[a] + max_radius, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t b = begin; b < end; ++b) {
        if (b == a) continue;
        const float square = squared_distance(cells, a, b), reach = radius[a] + radius[b];
        if (square >= reach * reach) continue;
        if (out != nullptr) out[found] = b;
        ++found;
      }
    });
    return found;
  };
  for_each_index(
      n, [=] ESPDIFF_HD(std::size_t a) { first[a] = visit_neighbours(static_cast<std::uint32_t>(a), nullptr); });
  const std::uint32_t total = exclusive_scan_in_place(atoms.first);
  atoms.neighbour.resize(total);
  std::uint32_t* const neighbour = raw(atoms.neighbour);
  for_each_index(
      n, [=] ESPDIFF_HD(std::size_t a) { visit_neighbours(static_cast<std::uint32_t>(a), neighbour + first[a]); });
  sort_nearest_first(cells, static_cast<std::uint32_t>(n), first, atoms.neighbour);
}

/// The circle in which the spheres of two atoms intersect.
struct Circle {
  Vec3f centre, axis, u, v;  ///< u, v, axis: an orthonormal frame
  float radius;              ///< 0 if they do not intersect
};

ESPDIFF_INLINE Circle circle_between(const ProbeAtomsView& atoms, std::uint32_t a, std::uint32_t b) {
  Circle circle{};
  const Vec3f from = atoms.centre(a), way = atoms.centre(b) - from;
  const float d = sqrtf(dot(way, way)), ra = atoms.radius[a], rb = atoms.radius[b];
  if (!(d > 1e-4F)) return circle;
  const float along = 0.5F * (d + (ra * ra - rb * rb) / d), square = ra * ra - along * along;
  if (!(square > 0.0F)) return circle;  // one sphere is inside the other
  circle.radius = sqrtf(square);
  circle.axis = (1.0F / d) * way;
  circle.centre = from + along * circle.axis;
  const Vec3f n = circle.axis;
  const Vec3f aside = fabsf(n.x) < 0.6F ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
  const Vec3f across = cross(n, aside);
  circle.u = (1.0F / sqrtf(dot(across, across))) * across;
  circle.v = cross(n, circle.u);
  return circle;
}

/// Arcs of a circle, as angles from u; of a whole circle, 0 to 2 pi.
struct Arcs {
  float begin[kMostArcs], end[kMostArcs];
  int n;

  /// Removes [from, to], 0 <= from <= to <= 2 pi.
  ESPDIFF_INLINE void remove(float from, float to) {
    const int before = n;
    for (int i = 0; i < before; ++i) {
      if (to <= begin[i] || from >= end[i]) continue;
      if (from > begin[i] && to < end[i]) {
        if (n < kMostArcs) {
          begin[n] = to;
          end[n] = end[i];
          ++n;
        }
        end[i] = from;
      } else if (from > begin[i]) {
        end[i] = from;
      } else {
        begin[i] = to < end[i] ? to : end[i];
      }
    }
    int kept = 0;
    for (int i = 0; i < n; ++i) {
      if (!(begin[i] < end[i])) continue;
      begin[kept] = begin[i];
      end[kept] = end[i];
      ++kept;
    }
    n = kept;
  }
};

/// Removes the part inside the sphere of atom c. Returns false if nothing is left.
ESPDIFF_INLINE bool cut_by(const ProbeAtomsView& atoms, std::uint32_t c, const Circle& circle, Arcs& arcs) {
  const Vec3f way = atoms.centre(c) - circle.centre;
  const float height = dot(way, circle.axis), x = dot(way, circle.u), y = dot(way, circle.v);
  const float square = atoms.radius[c] * atoms.radius[c] * kNotQuite - height * height - circle.radius * circle.radius;
  const float aside = sqrtf(x * x + y * y);
  // |point - c|^2 < R^2 where 2 rho aside cos(angle - direction) > rho^2 + aside^2 + height^2 - R^2.
  const float least = aside * aside - square, most = 2.0F * circle.radius * aside;
  if (least >= most) return true;
  if (least < -most) {
    arcs.n = 0;
    return false;
  }
  const float half = angle_of_cosine(larger(least / most, -1.0F));
  float from = angle_of_direction(y, x) - half;
  if (from < 0.0F) from += kTwoPi;
  const float to = from + 2.0F * half;
  if (to <= kTwoPi) {
    arcs.remove(from, to);
  } else {
    arcs.remove(from, kTwoPi);
    arcs.remove(0.0F, to - kTwoPi);
  }
  return arcs.n > 0;
}

ESPDIFF_INLINE Arcs exposed_arcs(const ProbeAtomsView& atoms, std::uint32_t a, std::uint32_t b, const Circle& circle) {
  Arcs arcs{};
  arcs.begin[0] = 0.0F;
  arcs.end[0] = kTwoPi;
  arcs.n = 1;
  for (std::uint32_t n = atoms.first[a]; n < atoms.first[a + 1]; ++n) {
    const std::uint32_t c = atoms.neighbour[n];
    if (c != b && !cut_by(atoms, c, circle, arcs)) break;
  }
  return arcs;
}

ESPDIFF_INLINE std::uint32_t points_of(float angle, float radius) {
  return static_cast<std::uint32_t>(angle * radius / kArcSpacing_A) + 2U;
}

/// Calls of_entry(atom, entry) for the entries of all atoms' neighbour lists.
template <typename OfEntry>
void for_each_neighbour(const ProbeAtoms& atoms, const OfEntry& of_entry) {
  const std::uint32_t* const first = raw(atoms.first);
  const std::uint32_t n_atoms = static_cast<std::uint32_t>(atoms.radius.size());
#if defined(ESPDIFF_BACKEND_CUDA)
  for_each_index(atoms.neighbour.size(), [=] ESPDIFF_HD(std::size_t index) {
    const std::uint32_t entry = static_cast<std::uint32_t>(index);
    of_entry(owner_of(first, n_atoms, entry), entry);
  });
#else
  for_each_index(n_atoms, [=](std::size_t a) {
    for (std::uint32_t entry = first[a]; entry < first[a + 1]; ++entry) of_entry(static_cast<std::uint32_t>(a), entry);
  });
#endif
}

/// An atom is exposed if one of its circles is, or if all its neighbours lie inside it.
/// @param n_circles [atom] those of its circles that are exposed
void find_exposed(ProbeAtoms& atoms, const Buffer<std::uint32_t>& n_circles) {
  const ProbeAtomsView view = view_of(atoms);
  const std::uint32_t* const circles = raw(n_circles);
  std::uint8_t* const exposed = raw(atoms.exposed);
  for_each_index(n_circles.size(), [=] ESPDIFF_HD(std::size_t index) {
    const std::uint32_t a = static_cast<std::uint32_t>(index);
    bool holds_all = true;
    for (std::uint32_t entry = view.first[a]; entry < view.first[a + 1] && holds_all; ++entry) {
      const std::uint32_t b = view.neighbour[entry];
      const Vec3f way = view.centre(b) - view.centre(a);
      holds_all = !(sqrtf(dot(way, way)) + view.radius[b] > view.radius[a]);
    }
    exposed[a] = circles[a] > 0 || holds_all ? 1 : 0;
  });
}

}  // namespace

ProbeAtomsView view_of(const ProbeAtoms& atoms) {
  return {atoms.cells->view(), raw(atoms.radius), raw(atoms.first), raw(atoms.neighbour), raw(atoms.exposed)};
}

ProbeAtoms make_probe_atoms(const std::vector<PbAtom>& atoms, float probe_radius) {
  std::vector<Vec3d> positions;
  std::vector<float> widths, radii;
  for (const PbAtom& atom : atoms) {
    positions.push_back(atom.position);
    radii.push_back(atom.radius + probe_radius);
    widths.push_back(radii.back() / kCutoffInWidths);
  }
  ProbeAtoms result;
  Buffer<std::uint32_t> order;
  result.cells = make_atom_cells(positions, widths, std::vector<std::int32_t>(atoms.size(), 0), &order);
  result.radius = in_cell_order(radii, order);
  return result;
}

Buffer<Vec4f> find_probe_positions(ProbeAtoms& atoms) {
  find_neighbours(atoms, atoms.cells->max_reach);
  const std::uint32_t n_atoms = static_cast<std::uint32_t>(atoms.radius.size());
  atoms.exposed.resize(n_atoms);
  const ProbeAtomsView view = view_of(atoms);
  const std::size_t n_entries = atoms.neighbour.size();
  Buffer<std::uint32_t> first_point(n_entries + 1, 0);
  std::uint32_t* const count = raw(first_point);
  Buffer<std::uint32_t> n_circles(n_atoms, 0);
  std::uint32_t* const circles = raw(n_circles);
  for_each_neighbour(atoms, [=] ESPDIFF_HD(std::uint32_t a, std::uint32_t entry) {
    const std::uint32_t b = view.neighbour[entry];
    if (b < a) return;
    const Circle circle = circle_between(view, a, b);
    if (!(circle.radius > 0.0F)) return;
    const Arcs arcs = exposed_arcs(view, a, b, circle);
    std::uint32_t n = 0;
    for (int i = 0; i < arcs.n; ++i) n += points_of(arcs.end[i] - arcs.begin[i], circle.radius);
    count[entry] = n;
    if (n == 0) return;
    atomic_increment(circles + a);
    atomic_increment(circles + b);
  });
  const std::uint32_t n_points = exclusive_scan_in_place(first_point);
  find_exposed(atoms, n_circles);
  Buffer<Vec4f> probes(n_points);
  Vec4f* const points = raw(probes);
  for_each_neighbour(atoms, [=] ESPDIFF_HD(std::uint32_t a, std::uint32_t entry) {
    std::uint32_t at = count[entry];
    if (count[entry + 1] == at) return;
    const Circle circle = circle_between(view, a, view.neighbour[entry]);
    const Arcs arcs = exposed_arcs(view, a, view.neighbour[entry], circle);
    for (int i = 0; i < arcs.n; ++i) {
      const float angle = arcs.end[i] - arcs.begin[i];
      const std::uint32_t n = points_of(angle, circle.radius);
      for (std::uint32_t step = 0; step < n; ++step) {
        const float at_angle = arcs.begin[i] + angle * (static_cast<float>(step) / static_cast<float>(n - 1));
        const Vec3f p =
            circle.centre + (circle.radius * cosf(at_angle)) * circle.u + (circle.radius * sinf(at_angle)) * circle.v;
        points[at++] = make_vec4(p, 0.0F);
      }
    }
  });
  return probes;
}

}  // namespace espdiff::ESPDIFF_BACKEND
