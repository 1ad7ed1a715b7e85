// certificate_forms.cpp: the certificate's stages give the same bits by blocks of points and point by point. Compiled
// with the CPU back end's flags, because the engine's interface offers only one of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cuda/certificate/intersections.h"
#include "cuda/certificate/slip.h"
#include "cuda/certificate/weighted_order.h"
#include "cuda/device/unwrap.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/density/atom_field.h"
#include "cuda/surface/density/vertex_residues.h"
#include "cuda/surface/distances_to_triangles.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/project.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;
using espdiff::MeshPtr;
using espdiff::MovingAtom;

namespace {

std::unique_ptr<espdiff::Engine> cpu() { return espdiff::select_engine(espdiff::DeviceChoice::kCpu, 0); }
const SurfaceMesh& mesh_of(const MeshPtr& mesh) { return unwrap<SurfaceMesh>(mesh); }

template <typename Number>
std::size_t n_different(const std::vector<Number>& a, const std::vector<Number>& b) {
  REQUIRE(a.size() == b.size());
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += std::memcmp(&a[i], &b[i], sizeof(Number)) == 0 ? 0 : 1;
  return n;
}

Mesh noisy_sphere(int levels, double radius, std::uint64_t seed) {
  Random random(seed);
  return moved(icosphere(levels, radius), [&](Vec3d p) { return p + random.in_box(0.3); });
}

/// Atoms that move by a little, paired one by one; one in `unpaired_share` has no partner at either end.
std::vector<MovingAtom> moving(const AtomSet& atoms, std::size_t unpaired_share, std::uint64_t seed) {
  Random random(seed);
  std::vector<MovingAtom> paths;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    MovingAtom path;
    path.start = atoms.positions[i];
    path.end = path.start + random.in_box(0.5);
    path.start_width = path.end_width = static_cast<double>(atoms.widths[i]);
    path.own_rotation = random.in_box(0.3);
    path.pair = static_cast<std::int32_t>(i);
    if (unpaired_share > 0 && i % unpaired_share == 0) {
      path.pair = -1;
      path.at_end = i % 2 == 0;
      path.at_start = !path.at_end;
    }
    paths.push_back(path);
  }
  return paths;
}

std::size_t n_slips_that_differ(espdiff::Engine& engine, const AtomSet& atoms, std::size_t unpaired_share) {
  const auto mesh = engine.isosurface(engine.density(upload(engine, atoms), 0.8), 0.5F);
  Random random(31);
  Mesh shape = engine.download(mesh);
  for (auto& p : shape.positions) p = p + static_cast<Vec3f>(random.in_box(0.4));
  const auto target = engine.upload_mesh(shape);
  const auto paths = moving(atoms, unpaired_share, 32);
  const SurfaceMesh& source = mesh_of(mesh);
  return n_different(slip(source, mesh_of(target), mesh_of(target), paths),
                     slip_point_by_point(source, mesh_of(target), mesh_of(target), paths));
}

/// Atoms in a small box, so that all of them reach every point.
AtomSet crowd(std::size_t n) {
  Random random(33);
  AtomSet atoms;
  for (std::size_t i = 0; i < n; ++i) atoms.add(random.in_box(2.0), 1.7, static_cast<std::int32_t>(i));
  return atoms;
}

std::size_t n_labels_that_differ(espdiff::Engine& engine, const AtomSet& atoms) {
  const auto mesh = engine.isosurface(engine.density(upload(engine, atoms), 0.8), 0.5F);
  const auto cells = make_atom_cells(atoms.positions, atoms.widths, atoms.residues);
  return n_different(to_host(vertex_residues(mesh_of(mesh), *cells)),
                     to_host(vertex_residues_point_by_point(mesh_of(mesh), *cells)));
}

std::size_t n_means_that_differ(espdiff::Engine& engine, const AtomSet& atoms) {
  const auto mesh = engine.isosurface(engine.density(upload(engine, atoms), 0.8), 0.5F);
  espdiff::AtomValues values{atoms.positions, atoms.widths, {}};
  for (std::size_t i = 0; i < atoms.size(); ++i)
    values.values.push_back(i % 6 == 1 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i % 13));
  return n_different(to_host(atom_field(mesh_of(mesh), values)),
                     to_host(atom_field_point_by_point(mesh_of(mesh), values)));
}

}  // namespace

TEST_SUITE_BEGIN("certificate forms");

TEST_CASE("means of atoms' values: blocks and single points agree") {
  const auto engine = cpu();
  CHECK(n_means_that_differ(*engine, random_cloud(300, 34)) == 0);
  CHECK(n_means_that_differ(*engine, crowd(400)) == 0);
}

TEST_CASE("distances to triangles: blocks, single points and all triangles agree, wherever the points lie") {
  const auto engine = cpu();
  for (const int levels : {0, 2, 4}) {
    const MeshPtr mesh = engine->upload_mesh(noisy_sphere(levels, 6.0, 40));
    const TriangleTree tree = make_triangle_tree(mesh_of(mesh));
    const std::vector<PlacedTriangle> triangles = to_host(tree.triangles);
    for (const double half_side : {0.5, 7.0, 60.0}) {  // inside, around, mostly far away
      Random random(41);
      std::vector<espdiff::Vec4f> where;
      for (int i = 0; i < 501; ++i)
        where.push_back(espdiff::make_vec4(static_cast<Vec3f>(random.in_box(half_side)), 0));
      for (const PlacedTriangle& t : triangles) where.push_back(espdiff::make_vec4(t.b, 0));  // on the surface
      const Buffer<espdiff::Vec4f> points = to_device(where);
      const std::vector<float> a = to_host(distances_to_triangles(tree, points));
      CAPTURE(levels);
      CAPTURE(half_side);
      CHECK(n_different(a, to_host(distances_point_by_point(tree, points))) == 0);
      std::size_t n_wrong = 0;
      for (std::size_t i = 0; i < where.size(); i += 7) {
        float least = std::numeric_limits<float>::infinity();
        for (const PlacedTriangle& t : triangles)
          least = std::fmin(least, squared_distance_to_triangle(where[i].xyz(), t));
        n_wrong += std::sqrt(least) == a[i] ? 0 : 1;
      }
      CHECK(n_wrong == 0);
    }
  }
}

TEST_CASE("distances between real surfaces agree in both forms") {
  const auto path = real_input("ubq/ubq.pqr"), other = real_input("series19_ubq_2k39/m03.pqr");
  if (!path || !other) return;
  const auto engine = cpu();
  const auto surface = [&](const std::string& file) {
    return engine->isosurface(engine->density(upload(*engine, read_atoms(file)), 1.0), 0.5F);
  };
  const MeshPtr a = surface(*path), b = surface(*other);
  const TriangleTree tree = make_triangle_tree(mesh_of(b));
  CHECK(n_different(to_host(distances_to_triangles(tree, mesh_of(a).positions)),
                    to_host(distances_point_by_point(tree, mesh_of(a).positions))) == 0);
}

TEST_CASE("intersections agree in both forms, from one triangle's neighbours to a crumpled surface") {
  const auto engine = cpu();
  const auto check = [&](const Mesh& mesh) {
    const MeshPtr uploaded = engine->upload_mesh(mesh);
    const espdiff::IntersectionReport a = self_intersections(mesh_of(uploaded)),
                                      b = self_intersections_leaf_by_leaf(mesh_of(uploaded));
    CHECK(a.n_pairs == b.n_pairs);
    CHECK(a.n_degenerate == b.n_degenerate);
    CHECK(engine->download(a.intersecting) == engine->download(b.intersecting));
    return a.n_pairs;
  };
  for (const int levels : {0, 1, 2, 3, 4, 5}) {
    CHECK(check(icosphere(levels, 6.0)) == 0);
    check(noisy_sphere(levels, 6.0, 42));
  }
  CHECK(check(noisy_sphere(5, 4.0, 43)) > 100);
  Mesh flat = icosphere(3, 6.0);
  for (std::size_t v = 0; v < flat.positions.size(); v += 5) flat.positions[v] = flat.positions[0];
  CHECK(check(flat) > 0);
}

TEST_CASE("projection gives the same bits in blocks and vertex by vertex") {
  const auto engine = cpu();
  const auto check = [&](const AtomSet& atoms, double spacing, float max_shift_A) {
    const auto cells = make_atom_cells(atoms.positions, atoms.widths, atoms.residues);
    const auto mesh = engine->isosurface(engine->density(upload(*engine, atoms), spacing), 0.5F);
    const auto blocks = to_host(project(mesh_of(mesh), *cells, 0.5F, max_shift_A)->positions),
               singly = to_host(project_vertex_by_vertex(mesh_of(mesh), *cells, 0.5F, max_shift_A)->positions);
    CHECK(n_different(blocks, singly) == 0);
    const std::vector<espdiff::Vec4f> given = to_host(mesh_of(mesh).positions);
    CHECK(n_different(blocks, given) > blocks.size() / 4);
    // From a vertex on: those before it stay, the others are the same.
    const auto half = static_cast<std::ptrdiff_t>(given.size() / 2);
    std::vector<espdiff::Vec4f> expected(given.begin(), given.begin() + half);
    for (espdiff::Vec4f& x : expected) x.w = 0.0F;
    expected.insert(expected.end(), blocks.begin() + half, blocks.end());
    const auto first = static_cast<std::size_t>(half);
    CHECK(n_different(expected, to_host(project(mesh_of(mesh), *cells, 0.5F, max_shift_A, first)->positions)) == 0);
    CHECK(n_different(expected,
                      to_host(project_vertex_by_vertex(mesh_of(mesh), *cells, 0.5F, max_shift_A, first)->positions)) ==
          0);
  };
  check(random_cloud(150, 46), 0.8, 0.5F);
  check(random_cloud(150, 47), 1.5, 0.05F);  // many would move too far, and stay
  const auto path = real_input("ubq/ubq.pqr");
  if (path) check(read_atoms(*path), 1.0, 0.5F);
}

TEST_CASE("weighted quantiles are those of a serial sum over the sorted values") {
  Random random(44);
  for (const std::size_t n : {1, 2, 2047, 2048, 2049, 10000}) {
    std::vector<float> values, weights;
    for (std::size_t i = 0; i < n; ++i) {
      // Many equal values, of both signs; weights whose sums are exact.
      values.push_back(static_cast<float>(std::round(400 * random.in_box(1).x)) / 16.0F + 0.0F);
      weights.push_back(static_cast<float>(random.below(1000)) / 64.0F);
    }
    if (n > 2) values[n / 2] = std::numeric_limits<float>::infinity();
    std::vector<std::pair<float, float>> sorted;
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      sorted.emplace_back(values[i], weights[i]);
      total += static_cast<double>(weights[i]);
    }
    std::sort(sorted.begin(), sorted.end());
    const std::vector<double> shares = {0, 0.05, 0.25, 0.5, 0.95, 1, 2, std::numeric_limits<double>::infinity()};
    WeightedOrder order(to_device(values), to_device(weights));
    HostReads reads;
    order.read_sums(reads);
    reads.wait();
    const std::vector<float> found = order.quantiles(total, shares);
    for (std::size_t s = 0; s < shares.size(); ++s) {
      double below = 0;
      float expected = sorted.back().first;
      for (const auto& [value, weight] : sorted) {
        below += static_cast<double>(weight);
        if (!(below >= shares[s] * total)) continue;
        expected = value;
        break;
      }
      CAPTURE(n);
      CAPTURE(shares[s]);
      CHECK(found[s] == expected);
    }
  }
}

TEST_CASE("vertex residues agree in both forms, with few labels and with more than a table holds") {
  const auto engine = cpu();
  CHECK(n_labels_that_differ(*engine, crowd(200)) == 0);
  CHECK(n_labels_that_differ(*engine, crowd(400)) == 0);
  AtomSet unlabelled = crowd(60);
  for (std::size_t i = 0; i < unlabelled.size(); i += 2) unlabelled.residues[i] = -1;
  CHECK(n_labels_that_differ(*engine, unlabelled) == 0);
  const auto path = real_input("ubq/ubq.pqr");
  if (path) CHECK(n_labels_that_differ(*engine, read_atoms(*path)) == 0);
}

TEST_CASE("slip agrees in both forms, with unpaired atoms and with more atoms than a block holds") {
  const auto engine = cpu();
  CHECK(n_slips_that_differ(*engine, crowd(100), 0) == 0);
  CHECK(n_slips_that_differ(*engine, crowd(100), 2) == 0);
  CHECK(n_slips_that_differ(*engine, crowd(700), 0) == 0);
  const auto path = real_input("ubq/ubq.pqr");
  if (path) CHECK(n_slips_that_differ(*engine, read_atoms(*path), 5) == 0);
}

TEST_SUITE_END();
