// morph_forms.cpp: internals of the morph: sums over moving atoms in both forms and against finite differences, and
// edge splitting. Compiled with the CPU back end's flags.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/device/spatial_order.h"
#include "cuda/morph/follow_level_set.h"
#include "cuda/morph/local_time_steps.h"
#include "cuda/morph/morph.h"
#include "cuda/morph/moving_atoms.h"
#include "cuda/morph/moving_surface.h"
#include "cuda/surface/density/density.h"
#include "cuda/surface/isosurface.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/mesh/split_edges.h"
#include "cuda/surface/shapes.h"
#include "engine/morph_stage.h"
#include "support/random.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;
using espdiff::MovingAtom;
using espdiff::Vec4f;

namespace {

std::vector<MovingAtom> random_paths(std::size_t n, std::uint64_t seed) {
  const AtomSet atoms = random_cloud(n, seed);
  Random random(seed + 100);
  std::vector<MovingAtom> ways;
  for (std::size_t i = 0; i < n; ++i) {
    MovingAtom way;
    way.start = atoms.positions[i];
    way.end = way.start + random.in_box(3);
    way.start_width = static_cast<double>(atoms.widths[i]);
    way.end_width = way.start_width * random.uniform(0.7, 1.4);
    way.at_start = i % 5 != 1;
    way.at_end = i % 5 != 2;
    ways.push_back(way);
  }
  return ways;
}

Buffer<Vec4f> random_points(std::size_t n, double half_side) {
  Random random(7);
  std::vector<Vec4f> points;
  for (std::size_t i = 0; i < n; ++i)
    points.push_back(espdiff::make_vec4(static_cast<Vec3f>(random.in_box(half_side)), 0));
  return to_device(points);
}

/// The density in double precision, atom by atom, without a cutoff.
double density_oracle(const std::vector<MovingAtom>& ways, Vec3d p, double time) {
  double sum = 0;
  for (const MovingAtom& a : ways) {
    const Vec3d d = p - ((1 - time) * a.start + time * a.end);
    const double width = (1 - time) * a.start_width + time * a.end_width;
    sum += a.weight_at(time) * std::exp(-dot(d, d) / (2 * width * width));
  }
  return sum;
}

std::shared_ptr<SurfaceMesh> surface_mesh(const Mesh& mesh) {
  auto surface = std::make_shared<SurfaceMesh>();
  std::vector<Corners> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({{t[0], t[1], t[2]}});
  std::vector<Vec4f> positions;
  for (const Vec3f p : mesh.positions) positions.push_back(espdiff::make_vec4(p, 0));
  surface->positions = to_device(positions);
  surface->topology = make_topology(mesh.positions.size(), to_device(triangles));
  return surface;
}

/// The mesh with the edges chosen (by their ends) split.
template <typename Chosen>
Mesh halved(const Mesh& mesh, Chosen chosen, std::size_t* n_new) {
  const auto surface = surface_mesh(mesh);
  const Topology& topology = *surface->topology;
  const std::vector<std::uint32_t> first = to_host(topology.first), neighbour = to_host(topology.neighbour);
  std::vector<std::uint32_t> marks(neighbour.size(), 0);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    for (std::uint32_t p = first[v]; p < first[v + 1]; ++p)
      marks[p] = v < neighbour[p] && chosen(v, neighbour[p]) ? 1 : 0;
  const EdgeSplit split = split_edges(topology, to_device(marks), surface->positions);
  Mesh result = mesh;
  for (const EdgeSplit::Ends& ends : to_host(split.ends))
    result.positions.push_back(0.5F * (mesh.positions[ends.a] + mesh.positions[ends.b]));
  *n_new = split.ends.size();
  result.triangles.clear();
  for (const Corners& c : to_host(split.topology->triangles)) result.triangles.push_back({c.v[0], c.v[1], c.v[2]});
  REQUIRE(split.parent.size() == result.triangles.size());
  // Each part lies in its parent's plane with the same orientation.
  const std::vector<std::uint32_t> parent = to_host(split.parent);
  for (std::size_t t = 0; t < parent.size(); ++t) {
    const auto normal = [](const Mesh& m, const espdiff::Triangle& c) {
      return cross(m.positions[c[1]] - m.positions[c[0]], m.positions[c[2]] - m.positions[c[0]]);
    };
    const Vec3f own = normal(result, result.triangles[t]), whole = normal(mesh, mesh.triangles[parent[t]]);
    CHECK(dot(own, whole) > 0.999F * norm(own) * norm(whole));
    CHECK(norm(own) > 0);
  }
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("morph");

TEST_CASE("blocks of points and single points give the same bits") {
  const std::vector<MovingAtom> few = random_paths(200, 21), many = random_paths(4000, 21);
  for (const std::size_t n_points : {1, 15, 16, 17, 1000}) {
    for (const double time : {0.0, 0.3, 1.0, 0.6}) {
      // More atoms near the points than a list of them holds, at the last time.
      const MovingAtoms atoms = atoms_at(time == 0.6 ? many : few, time);
      const Buffer<Vec4f> points = random_points(n_points, 12);
      const Buffer<std::uint32_t> order = spatial_order(points);
      Buffer<FlowSample> a(n_points), b(n_points);
      flow_at_points(atoms, points, order, n_points, a);
      flow_point_by_point(atoms, points, order, n_points, b);
      CAPTURE(n_points);
      CAPTURE(time);
      std::size_t n_different = 0;
      for (std::size_t i = 0; i < n_points; ++i) {
        const FlowSample x = a[i], y = b[i];
        n_different += std::memcmp(&x, &y, sizeof x) == 0 ? 0 : 1;
      }
      CHECK(n_different == 0);
    }
  }
}

TEST_CASE("vertices return to the level set with the same bits in blocks and one by one") {
  const std::vector<MovingAtom> paths = random_paths(200, 26);
  const MovingAtoms at_start = atoms_at(paths, 0.0);
  const auto density = density_by_points(*at_start.cells, density_lattice(*at_start.cells, 0.9));
  const auto mesh = isosurface(*density, 0.5F);
  MovingSurface blocks = start_surface(*mesh), singly = start_surface(*mesh);
  for (int step = 0; step < 4; ++step) {
    const MovingAtoms atoms = atoms_at(paths, 0.06 * step);
    for (MovingSurface* surface : {&blocks, &singly}) {
      advance(*surface, static_cast<std::uint32_t>(step + 1), 0.06F);
      end_intervals(*surface, static_cast<std::uint32_t>(step + 1), false);
    }
    return_to_level_set(blocks, atoms, 0.5F);
    return_vertex_by_vertex(singly, atoms, 0.5F);
    for (const auto member : {&MovingSurface::x, &MovingSurface::flow, &MovingSurface::gradient}) {
      const std::vector<Vec4f> a = to_host(blocks.*member), b = to_host(singly.*member);
      CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec4f)) == 0);
    }
    CHECK(to_host(blocks.unmatched) == to_host(singly.unmatched));
  }
  const std::vector<std::uint8_t> unmatched = to_host(blocks.unmatched);
  // Of vertices that have settled, only those that moved since return.
  const std::vector<Vec4f> before = to_host(blocks.x);
  std::vector<Vec4f> moved = before;
  for (std::size_t v = 0; v < moved.size(); v += 3) moved[v].x += 0.05F;
  const MovingAtoms same_atoms = atoms_at(paths, 0.18);
  for (MovingSurface* surface : {&blocks, &singly}) {
    surface->x = to_device(moved);
    wait_where_settled(*surface, to_device(before));
  }
  return_to_level_set(blocks, same_atoms, 0.5F);
  return_vertex_by_vertex(singly, same_atoms, 0.5F);
  const std::vector<Vec4f> after = to_host(blocks.x), after_singly = to_host(singly.x);
  CHECK(std::memcmp(after.data(), after_singly.data(), after.size() * sizeof(Vec4f)) == 0);
  std::size_t n_stay = 0, n_return = 0;
  for (std::size_t v = 0; v < after.size(); ++v) {
    if (v % 3 != 0) n_stay += std::memcmp(&after[v], &before[v], sizeof(Vec4f)) == 0 ? 1 : 0;
    if (v % 3 == 0) n_return += norm(after[v].xyz() - before[v].xyz()) < 0.049F ? 1 : 0;
  }
  CHECK(n_stay == after.size() - (after.size() + 2) / 3);
  CHECK(n_return > after.size() / 12);
  const auto n_unmatched = std::count(unmatched.begin(), unmatched.end(), 1);
  CHECK(n_unmatched > 0);
  CHECK(n_unmatched < static_cast<std::ptrdiff_t>(unmatched.size() / 2));
}

TEST_CASE("no vertex keeps its flow while an atom near it moves farther than allowed") {
  constexpr float kMost_A = 0.35F;
  constexpr std::uint32_t kLongest = 8;
  std::vector<MovingAtom> paths = random_paths(600, 28);
  Random random(29);
  std::vector<float> displacements_A;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    // Few atoms are fast, most hardly move.
    const double reach = i % 60 == 0 ? 0.35 : i % 20 == 0 ? 0.1 : 0.02;
    displacements_A.push_back(static_cast<float>(random.uniform(0, reach)));
  }
  const MovingAtoms atoms = atoms_at(paths, 0.0);
  const auto density = density_by_points(*atoms.cells, density_lattice(*atoms.cells, 0.9));
  MovingSurface surface = start_surface(*isosurface(*density, 0.5F));
  const auto intervals = [&](std::uint32_t step) {
    begin_intervals(surface, {displacements_A, kLongest, kMost_A}, atoms, step, 0.01F);
    return to_host(surface.clock);
  };
  const std::vector<VertexClock> clocks = intervals(0);
  const std::vector<Vec4f> x = to_host(surface.x);
  std::size_t n_longer = 0, n_shorter = 0;
  std::vector<std::size_t> n_of(kLongest + 1, 0);
  for (std::size_t v = 0; v < x.size(); ++v) {
    std::uint32_t expected = kLongest;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      // Half of 4.5 standard deviations.
      const double gap = norm(static_cast<Vec3d>(x[v].xyz()) - paths[i].start) - 2.25 * paths[i].start_width;
      const double displacement = static_cast<double>(displacements_A[i]);
      while (expected > 1 && expected * displacement > static_cast<double>(kMost_A) && gap < expected * displacement)
        expected /= 2;
    }
    REQUIRE(clocks[v].interval <= kLongest);
    ++n_of[clocks[v].interval];
    n_longer += clocks[v].interval > expected ? 1 : 0;
    n_shorter += clocks[v].interval < expected ? 1 : 0;
  }
  CHECK(n_longer <= x.size() / 1000);  // at the limit
  CHECK(n_shorter < x.size() / 4);     // neighbours share the shortest interval
  for (const std::uint32_t interval : {1U, 2U, 4U, 8U}) CHECK(n_of[interval] > 10);
  // Intervals of n steps begin at multiples of n, and a vertex that itself moves far has short ones.
  for (const VertexClock& clock : intervals(6)) CHECK(clock.interval <= 2);
  surface.flow.assign(surface.n_vertices(), espdiff::make_vec4(Vec3f{0, 0, 9}, 0.0F));  // 0.09 A a step
  for (const VertexClock& clock : intervals(0)) CHECK(clock.interval <= 2);
  surface.flow.assign(surface.n_vertices(), espdiff::make_vec4(Vec3f{}, -18.0F));
  for (const VertexClock& clock : intervals(0)) CHECK(clock.interval == 1);
}

TEST_CASE("atoms lie in their cells in the order of the input, without those of no width") {
  Random random(27);
  for (const std::size_t n : {1, 2, 500, 5000}) {
    std::vector<Vec3d> positions;
    std::vector<float> widths;
    std::vector<std::int32_t> residues;
    for (std::size_t i = 0; i < n; ++i) {
      positions.push_back(random.in_box(n == 500 ? 2.0 : 15.0));  // all in few cells, or spread
      widths.push_back(i % 4 == 1 ? 0.0F : static_cast<float>(random.uniform(0.8, 2.0)));
      residues.push_back(static_cast<std::int32_t>(i / 3));
    }
    Buffer<std::uint32_t> order;
    const auto cells = make_atom_cells(positions, widths, residues, &order);
    const AtomCellsView view = cells->view();
    std::vector<std::pair<int, std::uint32_t>> expected;  // cell, atom
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec3f p = static_cast<Vec3f>(positions[i]);
      const int cell = view.clamped_cell(p.x, 0) +
                       view.size[0] * (view.clamped_cell(p.y, 1) + view.size[1] * view.clamped_cell(p.z, 2));
      if (widths[i] > 0) expected.emplace_back(cell, i);
    }
    std::sort(expected.begin(), expected.end());
    CAPTURE(n);
    REQUIRE(order.size() == expected.size());
    REQUIRE(cells->first.size() == static_cast<std::size_t>(view.size[0] * view.size[1] * view.size[2]) + 1);
    std::size_t n_wrong = 0;
    for (std::uint32_t place = 0; place < expected.size(); ++place) {
      const auto [cell, i] = expected[place];
      const Vec3f p = static_cast<Vec3f>(positions[i]);
      const bool right = order[place] == i && view.first[cell] <= place && place < view.first[cell + 1] &&
                         view.x[place] == p.x && view.y[place] == p.y && view.z[place] == p.z &&
                         view.residue[place] == residues[i] && view.reach[place] == kCutoffInWidths * widths[i] &&
                         view.exponent[place] == -0.5F / (widths[i] * widths[i]);
      n_wrong += right ? 0 : 1;
    }
    CHECK(n_wrong == 0);
    CHECK(view.first[0] == 0);
    CHECK(cells->first.back() == expected.size());
  }
}

TEST_CASE("density, gradient and rate agree with finite differences in double precision") {
  const std::vector<MovingAtom> ways = random_paths(200, 22);
  constexpr std::size_t kPoints = 200;
  const double time = 0.4, step = 1e-5;
  const Buffer<Vec4f> points = random_points(kPoints, 8);
  Buffer<FlowSample> samples(kPoints);
  flow_at_points(atoms_at(ways, time), points, spatial_order(points), kPoints, samples);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Vec4f point = points[i];
    const Vec3d p = static_cast<Vec3d>(point.xyz());
    const FlowSample s = samples[i];
    CHECK(std::fabs(static_cast<double>(s.density) - density_oracle(ways, p, time)) < 2e-3);
    const double rate = (density_oracle(ways, p, time + step) - density_oracle(ways, p, time - step)) / (2 * step);
    CHECK(std::fabs(static_cast<double>(s.rate) - rate) < 0.02 + 1e-3 * std::fabs(rate));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d e{};
      e[axis] = step;
      const double slope = (density_oracle(ways, p + e, time) - density_oracle(ways, p - e, time)) / (2 * step);
      CHECK(std::fabs(static_cast<double>(s.gradient[axis]) - slope) < 5e-3);
    }
  }
}

TEST_CASE("the velocity is the atoms' where all move alike, and zero without atoms") {
  std::vector<MovingAtom> ways = random_paths(50, 23);
  for (MovingAtom& way : ways) way.end = way.start + Vec3d{1, -2, 3};
  const Buffer<Vec4f> points = to_device(std::vector<Vec4f>{{0, 0, 0, 0}, {2, 1, 0, 0}, {500, 0, 0, 0}});
  Buffer<FlowSample> samples(3);
  flow_at_points(atoms_at(ways, 0.5), points, spatial_order(points), 3, samples);
  for (const std::size_t i : {0, 1}) {
    const FlowSample s = samples[i];
    CHECK(static_cast<double>(norm(s.velocity - Vec3f{1, -2, 3})) < 1e-5);
  }
  const FlowSample far = samples[2];
  CHECK(norm(far.velocity) == 0);
  CHECK(far.density == 0);
}

TEST_CASE("the velocity follows the atoms' rotating surroundings, weighted by the square roots of their densities") {
  Random random(24);
  std::vector<MovingAtom> ways = random_paths(60, 25);
  for (MovingAtom& way : ways) {
    way.motion.axis = random.direction();
    way.motion.angle = random.uniform(-1, 1);
    way.own_rotation = random.in_box(1);
  }
  constexpr std::size_t kPoints = 100;
  const double time = 0.4;
  const Buffer<Vec4f> points = random_points(kPoints, 6);
  Buffer<FlowSample> samples(kPoints);
  flow_at_points(atoms_at(ways, time), points, spatial_order(points), kPoints, samples);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Vec4f point = points[i];
    Vec3d sum{};
    double all = 0;
    for (const MovingAtom& a : ways) {
      const Vec3d d = static_cast<Vec3d>(point.xyz()) - a.position_at(time);
      const double width = (1 - time) * a.start_width + time * a.end_width;
      if (dot(d, d) > 4.5 * 4.5 * width * width) continue;
      const double weight = a.weight_at(time) * std::exp(-dot(d, d) / (4 * width * width));
      all += weight;
      sum += weight * (a.velocity_at(time) + cross(a.spin_at(time), d));
    }
    const FlowSample s = samples[i];
    CHECK(norm(static_cast<Vec3d>(s.velocity) - (1 / all) * sum) < 1e-3);
  }
}

TEST_CASE("a fading atom has its weight in the half of the path where it exists") {
  MovingAtom appears, leaves;
  appears.at_start = false;
  leaves.at_end = false;
  for (const double time : {0.0, 0.2, 0.5, 0.7, 1.0}) {
    CHECK(appears.weight_at(time) == doctest::Approx(std::min(1.0, 2 * time)));
    CHECK(leaves.weight_at(time) == doctest::Approx(appears.weight_at(1 - time)));
  }
  CHECK(appears.weight_rate_at(0.2) == doctest::Approx(2));
  CHECK(appears.weight_rate_at(0.7) == 0);
  CHECK(leaves.weight_rate_at(0.2) == 0);
  CHECK(leaves.weight_rate_at(0.7) == doctest::Approx(-2));
}

TEST_CASE("splitting edges keeps the surface closed and its shape unchanged") {
  const Mesh sphere = icosphere(2, 5);
  Random random(9);
  for (int trial = 0; trial < 20; ++trial) {
    const std::uint32_t share = static_cast<std::uint32_t>(trial);
    std::size_t n_new = 0, n_chosen = 0;
    const Mesh divided = halved(
        sphere,
        [&](std::uint32_t, std::uint32_t) {
          const bool yes = random.below(19) < share;
          n_chosen += yes ? 1 : 0;
          return yes;
        },
        &n_new);
    CAPTURE(trial);
    CHECK(n_new == n_chosen);
    CHECK(manifold_fault(divided).empty());
    CHECK(euler_characteristic(divided) == 2);
    CHECK(signed_volume(divided) == doctest::Approx(signed_volume(sphere)).epsilon(1e-5));
    CHECK(divided.triangles.size() == sphere.triangles.size() + 2 * n_new);
  }
}

TEST_CASE("the shorter diagonal divides the quadrangle that two split edges leave") {
  // A tetrahedron with one flat, skew face 0 1 2: splitting 0-1 and 1-2 leaves the quadrangle 0, m01, m12, 2.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {2, 1, -3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {2, 1, 3}};
  std::size_t n_new = 0;
  const Mesh divided = halved(
      mesh, [](std::uint32_t a, std::uint32_t b) { return (a == 0 && b == 1) || (a == 1 && b == 2); }, &n_new);
  REQUIRE(n_new == 2);
  // m01 = (2, 0, 0) to vertex 2 is 2.24 long, vertex 0 to m12 = (3.5, 1, 0) 3.64.
  const auto has_edge = [&](std::uint32_t a, std::uint32_t b) {
    return std::any_of(divided.triangles.begin(), divided.triangles.end(), [&](const espdiff::Triangle& t) {
      return std::count(t.begin(), t.end(), a) == 1 && std::count(t.begin(), t.end(), b) == 1;
    });
  };
  CHECK((has_edge(2, 4) || has_edge(2, 5)));
  const std::uint32_t m01 = norm(divided.positions[4] - Vec3f{2, 0, 0}) < 1e-6F ? 4 : 5, m12 = 9 - m01;
  CHECK(has_edge(2, m01));
  CHECK_FALSE(has_edge(0, m12));
}

TEST_CASE("the spatial order contains every point once, with neighbours next to each other") {
  const Buffer<Vec4f> points = random_points(4000, 20);
  std::vector<std::uint32_t> order = to_host(spatial_order(points));
  const std::vector<Vec4f> x = to_host(points);
  double along = 0, at_random = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    along += static_cast<double>(norm(x[order[i]].xyz() - x[order[i - 1]].xyz()));
    at_random += static_cast<double>(norm(x[i].xyz() - x[i - 1].xyz()));
  }
  CHECK(along < 0.2 * at_random);
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i) CHECK(order[i] == i);
}

TEST_SUITE_END();
