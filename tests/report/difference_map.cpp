// difference_map.cpp: the map around a surface: constants, linear fields, its band, its edge, a real surface, refusals.
#include "report/difference_map.h"
#include "mapping/input.h"
#include "options/options.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "io/structures/structure_file.h"
#include "mapping/build_surface.h"
#include "support/nan.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::surface_quantity_map;
using espdiff::Triangle;

namespace {

struct Surface {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;

  Grid map(const std::vector<float>& values, double spacing) const {
    return surface_quantity_map(positions, triangles, values, spacing);
  }
};

/// A sphere of 12 A, away from the origin; 2,562 vertices about 0.9 A apart.
Surface ball() {
  const Mesh mesh = icosphere(4, 12, {3.3, -7.1, 20.2});
  Surface surface;
  for (const Vec3f& p : mesh.positions) surface.positions.push_back(static_cast<Vec3d>(p));
  surface.triangles = mesh.triangles;
  return surface;
}

Vec3d point_of(const Grid& grid, std::size_t p) {
  const auto& l = grid.lattice;
  const auto nx = static_cast<std::size_t>(l.size[0]), ny = static_cast<std::size_t>(l.size[1]);
  return l.origin + static_cast<double>(p % nx) * l.step[0] + static_cast<double>(p / nx % ny) * l.step[1] +
         static_cast<double>(p / nx / ny) * l.step[2];
}

double distance_to(const std::vector<Vec3d>& positions, Vec3d x) {
  double least = std::numeric_limits<double>::max();
  for (const Vec3d& p : positions) least = std::min(least, dot(x - p, x - p));
  return std::sqrt(least);
}

/// As VMD samples a volume.
double trilinear(const Grid& grid, Vec3d x) {
  const auto& l = grid.lattice;
  std::size_t cell[3];
  double t[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double u = (x[axis] - l.origin[axis]) / l.step[static_cast<std::size_t>(axis)][axis];
    REQUIRE(u >= 0);
    REQUIRE(u < l.size[static_cast<std::size_t>(axis)] - 1);
    cell[axis] = static_cast<std::size_t>(u);
    t[axis] = u - std::floor(u);
  }
  double sum = 0;
  const auto nx = static_cast<std::size_t>(l.size[0]), ny = static_cast<std::size_t>(l.size[1]);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1U, j = corner >> 1U & 1U, k = corner >> 2U;
    const double weight = (i != 0 ? t[0] : 1 - t[0]) * (j != 0 ? t[1] : 1 - t[1]) * (k != 0 ? t[2] : 1 - t[2]);
    sum += weight * static_cast<double>(grid.values[cell[0] + i + nx * (cell[1] + j + ny * (cell[2] + k))]);
  }
  return sum;
}

/// Root mean square deviation of the map at the vertices from their values, over the standard deviation of the values.
double relative_deviation(const Grid& map, const Surface& surface, const std::vector<float>& values) {
  double square = 0, sum = 0, sum_square = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    const double deviation = trilinear(map, surface.positions[i]) - value;
    square += deviation * deviation;
    sum += value;
    sum_square += value * value;
  }
  const auto n = static_cast<double>(values.size());
  return std::sqrt(square / (sum_square - sum * sum / n));
}

}  // namespace

TEST_CASE("a constant stays constant in the band, falls to zero behind it, and the lattice ends where it is zero") {
  const Surface surface = ball();
  for (const double spacing : {1.0, 0.7}) {
    const Grid map = surface.map(std::vector<float>(surface.positions.size(), -2.5F), spacing);
    REQUIRE(map.values.size() == map.lattice.n_points());
    std::size_t n_band = 0, n_between = 0, n_zero = 0;
    const auto& size = map.lattice.size;
    for (std::size_t p = 0; p < map.values.size(); ++p) {
      const double distance = distance_to(surface.positions, point_of(map, p));
      const float value = map.values[p];
      if (distance <= espdiff::kMapBand_A) {
        ++n_band;
        REQUIRE(value == doctest::Approx(-2.5).epsilon(1e-6));
      } else if (distance < espdiff::kMapReach_A) {
        ++n_between;
        REQUIRE((value <= 0 && value >= -2.5F));
      } else {
        ++n_zero;
        REQUIRE(value == 0);
      }
      const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
      const std::size_t i = p % nx, j = p / nx % ny, k = p / nx / ny;
      const bool at_edge =
          i == 0 || j == 0 || k == 0 || i + 1 == nx || j + 1 == ny || k + 1 == static_cast<std::size_t>(size[2]);
      if (at_edge) REQUIRE(value == 0);
    }
    // 4/3 pi (16^3 - 8^3) A^3 within the band, and all of the shells between and of the ball's middle.
    CHECK(static_cast<double>(n_band) * spacing * spacing * spacing ==
          doctest::Approx(4 * kPi / 3 * (16 * 16 * 16 - 8 * 8 * 8)).epsilon(0.02));
    CHECK(n_between > 1000);
    CHECK(n_zero > 1000);
    CHECK(map.lattice.step[1] == Vec3d{0, spacing, 0});
    CHECK(map.unit == espdiff::PotentialUnit::kUnknown);
  }
}

TEST_CASE("at the vertices the map agrees with a smooth field within two hundredths of its spread") {
  const Surface surface = ball();
  std::vector<float> values;
  for (const Vec3d& p : surface.positions) values.push_back(static_cast<float>(0.3 * p.x - 0.1 * p.y + p.z));
  const double at_one = relative_deviation(surface.map(values, 1.0), surface, values);
  const double at_half = relative_deviation(surface.map(values, 0.5), surface, values);
  MESSAGE("relative deviation ", at_one, " at 1 A, ", at_half, " at 0.5 A");
  CHECK(at_one < 0.02);
  CHECK(at_half < 0.02);
}

TEST_CASE("each value is the area-weighted Gaussian mean") {
  const Surface surface = ball();
  std::vector<float> values;
  Random random(7);
  for (std::size_t i = 0; i < surface.positions.size(); ++i)
    values.push_back(static_cast<float>(random.uniform(-3, 3)));
  std::vector<double> area(values.size());
  for (const Triangle& t : surface.triangles) {
    const auto& p = surface.positions;
    for (const auto v : t) area[v] += norm(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])) / 6;
  }
  const Grid map = surface.map(values, 1.3);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  int n_checked = 0;
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    REQUIRE(map.values[p] >= std::min(*low, 0.0F));
    REQUIRE(map.values[p] <= std::max(*high, 0.0F));
    const Vec3d x = point_of(map, p);
    if (p % 5 != 0 || distance_to(surface.positions, x) > espdiff::kMapBand_A) continue;
    double weights = 0, sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double square = dot(surface.positions[i] - x, surface.positions[i] - x);
      if (square > espdiff::kMapReach_A * espdiff::kMapReach_A) continue;
      weights += area[i] * std::exp(-square / 2);
      sum += area[i] * std::exp(-square / 2) * static_cast<double>(values[i]);
    }
    REQUIRE(static_cast<double>(map.values[p]) == doctest::Approx(sum / weights).epsilon(1e-5));
    ++n_checked;
  }
  CHECK(n_checked > 1000);
}

TEST_CASE("vertices without a value are left out, and have no map far from others") {
  const Surface surface = ball();
  std::vector<float> values(surface.positions.size(), 4.0F);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (surface.positions[i].x > 3.3) values[i] = kNan;
  }
  const Grid map = surface.map(values, 1.0);
  CHECK(std::none_of(map.values.begin(), map.values.end(), [](float v) { return std::isnan(v); }));
  CHECK(*std::max_element(map.values.begin(), map.values.end()) == doctest::Approx(4));
  const auto& l = map.lattice;
  CHECK(l.origin.x + (l.size[0] - 1) * l.step[0].x <= 3.3 + espdiff::kMapReach_A + 1);
  values.assign(values.size(), kNan);
  CHECK(message_of([&] { surface.map(values, 1.0); }) ==
        "no vertex of the surface has a value to make a map of; does the potential map cover it?");
}

TEST_CASE("a map of a real surface agrees with the values at its vertices within a tenth of their spread") {
  const auto path = real_input("series19_ubq_2k39/m00.pqr");
  if (!path) return;
  const espdiff::Molecule molecule = espdiff::read_structure(*path);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 0);
  const espdiff::SurfaceResult made = espdiff::make_surface(*engine, {&molecule, nullptr}, {}, false, {});
  const Surface surface{made.positions, made.mesh.triangles};
  std::vector<float> values;  // the smoothed potential of the charges
  for (const Vec3d& p : surface.positions) {
    double sum = 0;
    for (std::size_t a = 0; a < molecule.size(); ++a) {
      const Vec3d d = p - molecule.positions[a];
      sum += static_cast<double>(molecule.charges[a]) / std::sqrt(dot(d, d) + 4);
    }
    values.push_back(static_cast<float>(sum));
  }
  const Grid map = surface.map(values, 1.0);
  const double deviation = relative_deviation(map, surface, values);
  MESSAGE(surface.positions.size(), " vertices, relative deviation ", deviation);
  CHECK(deviation < 0.1);
  Hash first, second;
  CHECK(first.add(map.values).value() == second.add(surface.map(values, 1.0).values).value());
}

TEST_CASE("spacings and numbers that cannot be are refused") {
  const Surface surface = ball();
  const std::vector<float> values(surface.positions.size(), 1.0F);
  const auto refusal = [&](double spacing) { return message_of([&] { surface.map(values, spacing); }); };
  CHECK(refusal(0) == "map spacing 0 A; 0.1 to 4 A was expected");
  CHECK(refusal(-1) == "map spacing -1 A; 0.1 to 4 A was expected");
  CHECK(refusal(0.05) == "map spacing 0.05 A; 0.1 to 4 A was expected");
  CHECK(refusal(4.5) == "map spacing 4.5 A; 0.1 to 4 A was expected");
  CHECK(refusal(static_cast<double>(kNan)) == "map spacing nan A; 0.1 to 4 A was expected");
  const std::string too_few = message_of([&] { surface.map({1, 2}, 1.0); });
  CHECK(too_few == "the map's surface has 2562 vertices, but 2 values were given; the numbers must be equal");
  Surface wide = surface;
  for (Vec3d& p : wide.positions) p = 50.0 * p;
  CHECK(message_of([&] { wide.map(values, 0.1); }) ==
        "a map with spacing 0.1 A around this surface has more than 2^31 - 1 points; take a larger spacing");
}
