// potential.cpp: cells, grids and frames of potentials; superposed frames; Coulomb's law; what is refused.
#include "potential/potential.h"
#include "potential/potential_series.h"
#include "support/test_data.h"

#include <cmath>
#include <limits>
#include <string>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "compare/made_side.h"
#include "cuda/potential/ewald_oracle.h"
#include "engine/engine.h"
#include "potential/cpu_engine.h"

using namespace espdiff_test;
using espdiff::GridChoice;
using espdiff::PotentialMethod;
using espdiff::PotentialOptions;
using espdiff::PotentialSeries;
using espdiff::UnitCell;

namespace {

void move_all(Molecule& molecule, const espdiff::RigidTransform& by) {
  for (Vec3d& p : molecule.positions) p = by.apply(p);
}

PotentialOptions with_align(espdiff::AlignAtoms atoms) {
  PotentialOptions options;
  options.align = atoms;
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("potential");

TEST_CASE("the grid is read as PMEPot reads it") {
  CHECK(espdiff::parse_grid_choice("1.5").resolution_A == 1.5);
  CHECK(espdiff::parse_grid_choice("1.5").size == std::array<int, 3>{0, 0, 0});
  CHECK(espdiff::parse_grid_choice("8").size == std::array<int, 3>{8, 8, 8});
  CHECK(espdiff::parse_grid_choice("{60 54 64}").size == std::array<int, 3>{60, 54, 64});
  CHECK(espdiff::parse_grid_choice("60,54,64").size == std::array<int, 3>{60, 54, 64});
  for (const char* wrong : {"", "0", "-1", "12.5", "60 54", "60 54 x", "nan", "60 54 0"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(espdiff::parse_grid_choice(wrong), espdiff::InputError);
  }
  CHECK(message_of([] { espdiff::parse_grid_choice("60 54"); }).find("has 2 numbers; give three numbers of points") !=
        std::string::npos);
}

TEST_CASE("a cell is read with braces or without") {
  for (const char* text : {"{{1 2 3} {10 0 0} {0 20 0} {0 0 30.5}}", "1,2,3, 10,0,0, 0,20,0, 0,0,30.5"}) {
    const PmeCell cell = espdiff::parse_cell(text);
    CHECK(cell.centre == Vec3d{1, 2, 3});
    CHECK(cell.edges[2] == Vec3d{0, 0, 30.5});
  }
  CHECK(message_of([] { espdiff::parse_cell("{0 0 0} {1 0 0}"); }).find("has 6 numbers; give twelve") !=
        std::string::npos);
}

TEST_CASE("grid sizes: PMEPot's own, or the least product of small primes") {
  const auto sizes = [](double a, double b, double c, double resolution, bool compatible) {
    GridChoice choice;
    choice.resolution_A = resolution;
    return espdiff::choose_grid_size(cell_of({a, b, c}, {90, 90, 90}, {}), choice, compatible);
  };
  // What PMEPot 1.0.4 answers: good_fft_dim 62.23, 42.43, 129, 257, 301, 513, 3.
  CHECK(sizes(62.23, 42.43, 129, 1, true) == std::array<int, 3>{64, 48, 144});
  CHECK(sizes(257, 301, 513, 1, true) == std::array<int, 3>{264, 324, 512});
  CHECK(sizes(3, 8, 8.01, 1, true) == std::array<int, 3>{8, 8, 10});
  CHECK(sizes(62.23, 42.43, 129, 1, false) == std::array<int, 3>{63, 45, 135});
  CHECK(sizes(22, 46, 3, 2, false) == std::array<int, 3>{12, 24, 8});
  CHECK(sizes(30, 32, 35, 1, false) == std::array<int, 3>{30, 32, 35});
  CHECK_THROWS_AS(sizes(30, 32, 35, 0, false), espdiff::InputError);
}

TEST_CASE("cells from lengths and angles, and around atoms") {
  const PmeCell octahedron = espdiff::cell_from({{42, 42, 42}, {109.4712206, 109.4712206, 109.4712206}}, {1, 1, 1});
  const auto& e = octahedron.edges;
  CHECK(dot(e[0], cross(e[1], e[2])) == doctest::Approx(42.0 * 42 * 42 * 4 / (3 * std::sqrt(3.0))).epsilon(1e-7));
  CHECK(espdiff::cell_from({{3, 4, 5}, {90, 90, 90}}, {}).edges[1] == Vec3d{0, 4, 0});
  CHECK(espdiff::cell_from({{3, 4, 5}, {90, 90, 90}}, {}).edges[2] == Vec3d{0, 0, 5});
  CHECK_THROWS_AS(espdiff::cell_from({{3, 4, 5}, {150, 150, 150}}, {}), espdiff::InputError);
  CHECK_THROWS_AS(espdiff::cell_from({{3, 4, 5}, {90, 90, 0}}, {}), espdiff::InputError);
  const PmeCell box = espdiff::padded_cell({{0, 0, 0}, {10, -4, 3}}, 10);
  CHECK(box.centre == Vec3d{5, -2, 1.5});
  CHECK(box.edges[0] == Vec3d{30, 0, 0});
  CHECK(box.edges[1] == Vec3d{0, 24, 0});
  CHECK_THROWS_AS(espdiff::padded_cell({{0, 0, 0}}, -1), espdiff::InputError);
  CHECK_THROWS_AS(espdiff::padded_cell({}, 10), espdiff::InputError);
}

TEST_CASE("a molecule without charges is refused with where charges come from") {
  Molecule molecule = make_side(3, 0).molecule;
  molecule.charges.clear();
  const std::string none = message_of([&] { espdiff::require_charges(molecule); });
  CHECK(none.find("molecule.pqr: has no charges") == 0);
  for (const char* source : {"PQR", "PSF", "prmtop"}) CHECK(none.find(source) != std::string::npos);
  molecule.charges.assign(molecule.size(), 0.0F);
  CHECK(message_of([&] { espdiff::require_charges(molecule); }).find("every atom has charge 0") != std::string::npos);
  CHECK_THROWS_AS(espdiff::potential_map(*cpu(), molecule, {}, {}), espdiff::InputError);
}

TEST_CASE("Coulomb's law: one charge, two dielectrics, and the same bits for any number of threads") {
  const std::vector<Vec3d> positions{{1, 2, 3}, {-4, 0, 2}};
  const std::vector<float> charges{2.0F, -0.5F};
  espdiff::Lattice lattice;
  lattice.size = {5, 4, 3};
  lattice.origin = {-6, -5, -4};
  lattice.step = {{{3.1, 0, 0}, {0, 2.9, 0}, {0.5, 0, 3.3}}};
  espdiff::CoulombOptions options;
  options.dielectric = 4;
  const auto map = [&](int n_threads) {
    const auto engine = cpu(n_threads);
    return engine->download(engine->coulomb_potential(positions, charges, lattice, options, {}));
  };
  for (const bool by_distance : {false, true}) {
    options.distance_dependent = by_distance;
    const Grid found = map(1);
    CHECK(found.unit == PotentialUnit::kKtPerE);
    for (std::size_t i = 0; i < found.values.size(); ++i) {
      double sum = 0;
      for (std::size_t a = 0; a < 2; ++a) {
        const double r = norm(lattice_point(lattice, i) - positions[a]);
        sum += kCoulombInKt * static_cast<double>(charges[a]) / (4 * r * (by_distance ? r : 1));
      }
      CHECK(static_cast<double>(found.values[i]) == doctest::Approx(sum).epsilon(1e-6));
    }
    CHECK(map(2).values == found.values);
    CHECK(map(4).values == found.values);
  }
  lattice.origin = positions[0];  // on an atom: as at 0.5 A
  options.distance_dependent = false;
  CHECK(static_cast<double>(map(1).values[0]) ==
        doctest::Approx(kCoulombInKt / 4 * (2 / 0.5 - 0.5 / norm(positions[0] - positions[1]))).epsilon(1e-6));
  options.dielectric = 0;
  CHECK(message_of([&] { map(1); }).find("dielectric constant 0 is not a positive number") == 0);
}

TEST_CASE("far from smeared charges PME and Coulomb's law differ by the images only") {
  if (!can_run()) return;
  // A dipole: its images, 60 A away, give a field of the order of d / L^3.
  Molecule molecule = make_side(4, 0, 20).molecule;
  molecule.positions.assign(20, Vec3d{});
  molecule.charges.assign(20, 0.0F);
  molecule.positions[0] = {0, 0, 1};
  molecule.positions[1] = {0, 0, -1};
  molecule.charges[0] = 1;
  molecule.charges[1] = -1;
  PotentialOptions options;
  options.pad_A = 30;
  options.grid.size = {60, 60, 62};
  const Grid pme = espdiff::potential_map(*cpu(), molecule, options, {});
  options.method = PotentialMethod::kCoulomb;
  const Grid bare = espdiff::potential_map(*cpu(), molecule, options, {});
  CHECK(espdiff::same_lattice(pme.lattice, bare.lattice));
  CHECK(pme.periodic);
  CHECK_FALSE(bare.periodic);
  std::size_t n = 0;
  for (std::size_t i = 0; i < pme.values.size(); ++i) {
    const Vec3d p = lattice_point(pme.lattice, i);
    if (norm(p) < 11 || norm(p) > 13 || std::fabs(p.z) < 6) continue;
    CHECK(static_cast<double>(pme.values[i]) == doctest::Approx(static_cast<double>(bare.values[i])).epsilon(0.05));
    ++n;
  }
  CHECK(n > 1000);
}

TEST_CASE("superposed frames: a molecule that only moves has the first frame's mean and no variance") {
  if (!can_run()) return;
  Random random(31);
  const Molecule first = make_side(5, 0, 150).molecule;
  const UnitCell cell{{40, 42, 44}, {80, 95, 100}};
  for (const bool has_cell : {true, false}) {
    const auto own = has_cell ? std::optional<UnitCell>(cell) : std::nullopt;
    const auto engine = cpu();
    // Turned, a molecule in a given cell would be another crystal; there it is shifted only.
    PotentialSeries series(*engine, with_align(espdiff::AlignAtoms::kAll));
    const Grid reference = series.step(first, own, {});
    double largest = 0;
    for (const float v : reference.values) largest = std::max(largest, std::fabs(static_cast<double>(v)));
    for (int i = 0; i < 3; ++i) {
      Molecule frame = first;
      espdiff::RigidTransform by = random_rigid(random, 25);
      if (has_cell) by = espdiff::RigidTransform{{1, 0, 0, 0, 1, 0, 0, 0, 1}, random.in_box(20)};
      move_all(frame, by);
      const Grid map = series.step(frame, own, {});
      CHECK_FALSE(map.periodic);
      CHECK(relative_max(map.values, reference.values) < 1e-4);
    }
    CHECK(series.average().n_frames() == 4);
    CHECK(relative_max(series.average().mean().values, reference.values) < 1e-4);
    for (const float v : series.average().variance().values) CHECK(std::sqrt(static_cast<double>(v)) < 1e-4 * largest);
  }
}

TEST_CASE("superposed frames of a molecule that the cell's border cuts: whole first, hence no variance") {
  if (!can_run()) return;
  // Atoms along a line that bends, each near the one before it, in one residue after the other.
  Molecule first = make_side(5, 0, 60).molecule;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double t = static_cast<double>(i);
    first.positions[i] = {6 * std::sin(0.3 * t), 5 * std::cos(0.2 * t), 0.4 * t};
  }
  const UnitCell cell{{40, 42, 44}, {80, 95, 100}};
  const espdiff::PmeCell edges = espdiff::cell_from(cell, {});
  const auto engine = cpu();
  PotentialSeries series(*engine, with_align(espdiff::AlignAtoms::kAll));
  const Grid reference = series.step(first, cell, {});
  for (const std::size_t cut : {std::size_t{20}, std::size_t{45}}) {
    Molecule frame = first;
    move_all(frame, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {3, -2, 5}});
    for (std::size_t i = cut; i < frame.size(); ++i) frame.positions[i] += edges.edges[2] - edges.edges[0];
    CHECK(relative_max(series.step(frame, cell, {}).values, reference.values) < 1e-4);
  }
}

TEST_CASE("without superposition a frame in its own cell is sampled on the first frame's lattice") {
  if (!can_run()) return;
  const Molecule first = make_side(6, 0, 150).molecule;
  Molecule second = first;
  const UnitCell small{{40, 42, 44}, {90, 90, 90}}, large{{41, 42.5, 45}, {90, 90, 90}};
  const auto engine = cpu();
  PotentialSeries series(*engine, {});
  const Grid a = series.step(first, small, {});
  const Grid b = series.step(second, large, {});
  CHECK(espdiff::same_lattice(a.lattice, b.lattice));
  CHECK(a.periodic);
  CHECK_FALSE(b.periodic);
  // The second map against the direct sum in its own cell.
  Charges charges{second.positions, second.charges};
  const PmeCell cell = espdiff::cell_from(large, espdiff::middle_of(second.positions));
  Random random(32);
  std::vector<Vec3d> points;
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) {
    const std::size_t p = random.below(b.values.size());
    points.push_back(lattice_point(b.lattice, p));
    values.push_back(static_cast<double>(b.values[p]));
  }
  CHECK(relative_rms(values, direct_ewald(charges, cell, 0.25, points)) < 1e-4);
}

TEST_CASE("a fixed cell serves every frame, and the mean is that of the maps") {
  if (!can_run()) return;
  PotentialOptions options;
  options.cell = cell_of({50, 52, 54}, {90, 90, 90}, {1, 2, 3});
  const auto engine = cpu();
  PotentialSeries series(*engine, options);
  std::vector<double> sum;
  for (std::uint64_t seed = 40; seed < 43; ++seed) {
    const Grid map = series.step(make_side(seed, 1.0, 80).molecule, std::nullopt, {});
    CHECK(map.periodic);
    sum.resize(map.values.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(map.values[i]) / 3;
  }
  const Grid mean = series.average().mean();
  CHECK(mean.periodic);
  for (std::size_t i = 0; i < sum.size(); i += 97)
    CHECK(static_cast<double>(mean.values[i]) == doctest::Approx(sum[i]).epsilon(1e-5));
}

TEST_CASE("options that exclude each other, and frames of other molecules, are refused") {
  const auto engine = cpu();
  PotentialOptions options = with_align(espdiff::AlignAtoms::kCAlpha);
  options.pme.compatible = true;
  options.pme.order = 4;
  CHECK(message_of([&] { PotentialSeries series(*engine, options); }) ==
        "`compatible` with superposition: PMEPot has none; leave one out");
  options = {};
  options.cell = cells()[0].cell;
  options.pad_A = 5;
  CHECK(message_of([&] { PotentialSeries series(*engine, options); }) ==
        "a cell and a padding were given; leave one out");
  if (!can_run()) return;
  PotentialSeries series(*engine, {});
  series.step(make_side(7, 0, 60).molecule, std::nullopt, {});
  CHECK(message_of([&] { series.step(make_side(7, 0, 50).molecule, std::nullopt, {}); }).find("a frame of 50 atoms") !=
        std::string::npos);
}

TEST_SUITE_END();
