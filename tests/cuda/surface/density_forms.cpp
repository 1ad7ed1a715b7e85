// density_forms.cpp: both forms of the density agree to the last bit: slabs and points of a lattice, blocks of points
// and single points. Compiled with the CPU back end's flags, because the engine's interface offers only one of them.
#include <doctest/doctest.h>

#include <cstring>
#include <vector>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/device/spatial_order.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/density/density.h"
#include "cuda/surface/density/density_at_points.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;

namespace {

/// Compares both forms; returns how many values differ in a bit.
std::size_t n_different(const AtomSet& atoms, double spacing) {
  const auto cells = make_atom_cells(atoms.positions, atoms.widths, atoms.residues);
  const CubicLattice lattice = density_lattice(*cells, spacing);
  const std::vector<float> a = to_host(density_by_slabs(*cells, lattice)->values);
  const std::vector<float> b = to_host(density_by_points(*cells, lattice)->values);
  REQUIRE(a.size() == lattice.n_points());
  REQUIRE(b.size() == a.size());
  std::size_t n = 0;
  for (std::size_t p = 0; p < a.size(); ++p) n += std::memcmp(&a[p], &b[p], sizeof(float)) == 0 ? 0 : 1;
  return n;
}

}  // namespace

TEST_SUITE_BEGIN("density");

TEST_CASE("slabs and points agree on random clouds, at small and large spacings") {
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    const AtomSet atoms = random_cloud(20 + 60 * (seed - 10), seed);
    for (const double spacing : {0.3, 0.5, 0.77, 1.0, 1.5, 3.0, 7.0, 40.0}) {
      CAPTURE(seed);
      CAPTURE(spacing);
      CHECK(n_different(atoms, spacing) == 0);
    }
  }
}

TEST_CASE("slabs and points agree for radii from tiny to huge") {
  for (const double width : {1e-3, 0.05, 0.4, 6.0, 25.0, 80.0}) {
    for (const double steps_per_width : {0.5, 2.0, 8.0}) {
      AtomSet atoms = one_gaussian({0, 0, 0}, width);
      atoms.add({width, 0.3 * width, -0.7 * width}, 1.3 * width);
      CAPTURE(width);
      CAPTURE(steps_per_width);
      CHECK(n_different(atoms, width / steps_per_width) == 0);
    }
  }
  // A wide and many narrow atoms: the cell list is made for the wide one.
  AtomSet atoms = random_cloud(200, 17);
  atoms.add({3, 2, 1}, 9.0);
  CHECK(n_different(atoms, 1.0) == 0);
}

TEST_CASE("slabs and points agree for all row lengths around the vector width") {
  for (int n = 1; n < 60; ++n) CHECK(n_different(one_gaussian({0.01 * n, 0, 0}, 1.0), 9.0 / n) == 0);
}

TEST_CASE("slabs and points agree on atoms that sit on lattice points, cell borders and the reach") {
  // Widths and positions that are multiples of one decimal: distances to lattice points equal the reach up to rounding.
  Random random(18);
  for (int trial = 0; trial < 60; ++trial) {
    const double step = trial % 3 == 0 ? 0.1 : trial % 3 == 1 ? 0.25 : 1.0 / 3;
    const Vec3d shift = trial % 2 == 0 ? Vec3d{} : Vec3d{61.7, -33.3, 12.1};
    AtomSet atoms;
    for (int n = 0; n < 40; ++n) {
      const Vec3d p{step * static_cast<double>(random.below(60)), step * static_cast<double>(random.below(60)),
                    step * static_cast<double>(random.below(60))};
      atoms.add(shift + p, step * static_cast<double>(2 + 2 * random.below(4)) / 4.5);
    }
    CAPTURE(trial);
    CHECK(n_different(atoms, step) == 0);
  }
}

TEST_CASE("slabs and points agree on real proteins") {
  for (const std::string name : {"ubq/ubq.pqr", "pair_t4l_maps/3lzm.pqr", "calb/1TCA.cif"}) {
    const auto path = real_input(name);
    if (!path) return;
    CAPTURE(name);
    CHECK(n_different(read_atoms(*path), 1.0) == 0);
  }
}

TEST_CASE("the slab form gives the same bits for any number of threads") {
  const AtomSet atoms = random_cloud(300, 19);
  std::uint64_t first = 0;
  for (const int n_threads : {1, 2, 3, 4}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
    const std::uint64_t hash =
        Hash().add(engine->download(engine->density(upload(*engine, atoms), 0.6)).values).value();
    if (n_threads == 1) first = hash;
    CHECK(hash == first);
  }
}

TEST_CASE("the lattice holds every atom's reach however far apart they are") {
  // Over a million points along one axis, yet few in total.
  AtomSet atoms = one_gaussian({0, 0, 0}, 0.5);
  atoms.add({1.2e6, 0, 0}, 0.5);
  const auto cells = make_atom_cells(atoms.positions, atoms.widths, atoms.residues);
  bool refused = false;
  CubicLattice lattice{};
  try {
    lattice = density_lattice(*cells, 1.0);
  } catch (const espdiff::MemoryError&) {
    refused = true;
  }
  if (!refused) CHECK(static_cast<double>(lattice.coordinate(0, lattice.size[0] - 1)) > 1.2e6 + 4.5 * 0.5);
}

TEST_CASE("blocks of points and single points agree, wherever the points lie") {
  for (const std::size_t n_points : {1, 15, 16, 17, 1000}) {
    for (const double half_side : {0.5, 8.0, 60.0}) {  // in one place, around the atoms, mostly beyond them
      const AtomSet atoms = random_cloud(300, 19);
      const auto cells = make_atom_cells(atoms.positions, atoms.widths, atoms.residues);
      Random random(20);
      std::vector<espdiff::Vec4f> where;
      for (std::size_t i = 0; i < n_points; ++i)
        where.push_back(espdiff::make_vec4(static_cast<Vec3f>(random.in_box(half_side)), 0));
      const Buffer<espdiff::Vec4f> points = to_device(where);
      const Buffer<std::uint32_t> order = spatial_order(points);
      Buffer<DensitySample> a(n_points), b(n_points);
      density_at_points(*cells, points, order, n_points, a);
      density_point_by_point(*cells, points, order, n_points, b);
      CAPTURE(n_points);
      CAPTURE(half_side);
      CHECK(std::memcmp(raw(a), raw(b), n_points * sizeof(DensitySample)) == 0);
    }
  }
}

TEST_SUITE_END();
