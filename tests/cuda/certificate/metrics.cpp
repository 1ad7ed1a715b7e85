// metrics.cpp: the comparison of two potentials on one mesh: constants, linear functions, sign rule, exclusions, an
// oracle.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Metrics;
using espdiff::ScalarsPtr;

namespace {

/// Uploads values. Only samples of a map make scalars, so vertex v of a made-up mesh is sampled at point v of a row;
/// NaN outside the map. Its triangles only have to be closed.
ScalarsPtr scalars(Engine& engine, const std::vector<float>& values) {
  espdiff::Grid grid;
  const int n = static_cast<int>(values.size());
  grid.lattice.size = {n, 2, 2};
  grid.lattice.origin = {0, -1, -1};
  grid.lattice.step = {{{1, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
  for (int row = 0; row < 4; ++row) grid.values.insert(grid.values.end(), values.begin(), values.end());
  for (float& value : grid.values) value = std::isnan(value) ? 0.0F : value;
  Mesh mesh;
  for (int v = 0; v < n; ++v) {
    mesh.positions.push_back({static_cast<float>(v), std::isnan(values[static_cast<std::size_t>(v)]) ? 9.0F : 0.0F, 0});
  }
  for (int v = 0; v + 2 < n; v += 3) {
    const std::uint32_t u = static_cast<std::uint32_t>(v);
    mesh.triangles.insert(mesh.triangles.end(), {{u, u + 1, u + 2}, {u, u + 2, u + 1}});
  }
  return engine.sample(engine.upload_map(grid, {}), engine.upload_mesh(mesh));
}

struct Case {
  Mesh source, mapped;
  std::vector<float> a, b;      // [vertex]
  std::vector<float> excluded;  // [triangle]
};

Metrics metrics_of(Engine& engine, const Case& c) {
  REQUIRE(c.source.positions == c.mapped.positions);
  const auto source = engine.upload_mesh(c.source);
  return engine.compare(source, source, scalars(engine, c.a), scalars(engine, c.b),
                        c.excluded.empty() ? nullptr : scalars(engine, c.excluded));
}

Metrics metrics_oracle(const Case& c) {
  const auto w = vertex_weights(c.mapped, [&](std::size_t t) {
    bool counts = c.excluded.empty() || c.excluded[t] == 0;
    for (const std::uint32_t v : c.mapped.triangles[t])
      counts = counts && std::isfinite(c.a[v]) && std::isfinite(c.b[v]);
    return counts;
  });
  double area = 0, abs_sum = 0, square = 0, sum = 0, sign = 0, aa = 0, bb = 0, ab = 0, displacement = 0;
  for (std::size_t v = 0; v < w.size(); ++v) {
    if (w[v] == 0) continue;
    const double a = static_cast<double>(c.a[v]), b = static_cast<double>(c.b[v]);
    area += w[v];
    abs_sum += w[v] * std::fabs(b - a);
    square += w[v] * (b - a) * (b - a);
    sum += w[v] * (b - a);
    sign += a * b < 0 ? w[v] : 0;
    aa += w[v] * a * a;
    bb += w[v] * b * b;
    ab += w[v] * a * b;
    displacement += w[v] * norm(static_cast<Vec3d>(c.mapped.positions[v]) - static_cast<Vec3d>(c.source.positions[v]));
  }
  Metrics m;
  m.area_A2 = area;
  m.mean_abs_difference = abs_sum / area;
  m.rms_difference = std::sqrt(square / area);
  m.mean_signed_difference = sum / area;
  m.sign_change_area_fraction = sign / area;
  m.hodgkin_index = 2 * ab / (aa + bb);
  m.carbo_index = ab / std::sqrt(aa * bb);
  m.mean_displacement_A = displacement / area;
  return m;
}

/// Weights are sums in single precision: their rounding, about 1e-7, stays in the ratios.
void check_close(const Metrics& m, const Metrics& e, double tolerance = 2e-6) {
  CHECK(m.area_A2 == doctest::Approx(e.area_A2).epsilon(tolerance));
  CHECK(m.mean_abs_difference == doctest::Approx(e.mean_abs_difference).epsilon(tolerance));
  CHECK(m.rms_difference == doctest::Approx(e.rms_difference).epsilon(tolerance));
  CHECK(m.mean_signed_difference == doctest::Approx(e.mean_signed_difference).epsilon(tolerance));
  CHECK(m.sign_change_area_fraction == doctest::Approx(e.sign_change_area_fraction).epsilon(tolerance));
  CHECK(m.hodgkin_index == doctest::Approx(e.hodgkin_index).epsilon(tolerance));
  CHECK(m.carbo_index == doctest::Approx(e.carbo_index).epsilon(tolerance));
  CHECK(m.mean_displacement_A == doctest::Approx(e.mean_displacement_A).epsilon(tolerance));
}

Case sphere_case(double a, double b) {
  Case c;
  c.source = c.mapped = icosphere(3, 4.0);
  c.a.assign(c.source.positions.size(), static_cast<float>(a));
  c.b.assign(c.source.positions.size(), static_cast<float>(b));
  return c;
}

}  // namespace

TEST_SUITE_BEGIN("metrics");

TEST_CASE("constant potentials differ by their difference everywhere") {
  for (const auto& engine : back_ends()) {
    const Case c = sphere_case(1.25, -0.5);
    const Metrics m = metrics_of(*engine, c);
    CHECK(m.area_A2 == doctest::Approx(area_oracle(c.mapped)).epsilon(1e-6));
    CHECK(m.mean_abs_difference == doctest::Approx(1.75));
    CHECK(m.rms_difference == doctest::Approx(1.75));
    CHECK(m.mean_signed_difference == doctest::Approx(-1.75));  // target - source
    CHECK(m.sign_change_area_fraction == doctest::Approx(1));
    CHECK(m.hodgkin_index == doctest::Approx(2 * 1.25 * -0.5 / (1.25 * 1.25 + 0.25)));
    CHECK(m.carbo_index == doctest::Approx(-1));
    CHECK(m.mean_displacement_A == 0);
  }
}

TEST_CASE("equal potentials have indices of 1, opposite ones of -1") {
  for (const auto& engine : back_ends()) {
    Case c = sphere_case(0, 0);
    Random random(90);
    for (std::size_t v = 0; v < c.a.size(); ++v) c.b[v] = c.a[v] = static_cast<float>(random.uniform(-3, 3));
    const Metrics equal = metrics_of(*engine, c);
    CHECK(equal.hodgkin_index == doctest::Approx(1).epsilon(1e-12));
    CHECK(equal.carbo_index == doctest::Approx(1).epsilon(1e-12));
    CHECK(equal.mean_abs_difference == 0);
    CHECK(equal.sign_change_area_fraction == 0);
    for (float& value : c.b) value = -value;
    const Metrics opposite = metrics_of(*engine, c);
    CHECK(opposite.hodgkin_index == doctest::Approx(-1).epsilon(1e-12));
    CHECK(opposite.carbo_index == doctest::Approx(-1).epsilon(1e-12));
    CHECK(opposite.sign_change_area_fraction == doctest::Approx(1));
    for (std::size_t v = 0; v < c.a.size(); ++v) c.b[v] = 3 * c.a[v];
    const Metrics scaled = metrics_of(*engine, c);
    CHECK(scaled.carbo_index == doctest::Approx(1).epsilon(1e-6));      // blind to scale
    CHECK(scaled.hodgkin_index == doctest::Approx(0.6).epsilon(1e-6));  // 2*3 / (1 + 9)
  }
}

TEST_CASE("a linear potential against none on a sphere has its analytic means") {
  // <|z|> = r/2, <z^2> = r^2/3, <z> = 0 over a sphere; the icosphere's flat facets differ by its second order.
  for (const auto& engine : back_ends()) {
    Case c = sphere_case(0, 0);
    c.source = c.mapped = icosphere(4, 4.0);
    c.a.assign(c.source.positions.size(), 0.0F);
    c.b.clear();
    for (const Vec3f& p : c.source.positions) c.b.push_back(p.z);
    const Metrics m = metrics_of(*engine, c);
    CHECK(m.mean_abs_difference == doctest::Approx(2).epsilon(2e-3));
    CHECK(m.rms_difference == doctest::Approx(4 / std::sqrt(3.0)).epsilon(1e-3));
    CHECK(std::fabs(m.mean_signed_difference) < 1e-5);
    CHECK(m.sign_change_area_fraction == 0);  // zero agrees with anything
  }
}

TEST_CASE("a potential of zero agrees with either sign") {
  for (const auto& engine : back_ends()) {
    Case c = sphere_case(0, 0);
    const float values[] = {-1, 0, 1, -0.0F, 1e-30F, -1e-30F};
    for (std::size_t v = 0; v < c.a.size(); ++v) {
      c.a[v] = values[v % 6];
      c.b[v] = values[v / 6 % 6];
    }
    const auto w = vertex_weights(c.mapped, [](std::size_t) { return true; });
    double area = 0, sign = 0;
    for (std::size_t v = 0; v < w.size(); ++v) {
      area += w[v];
      // Not by the product, which underflows to zero.
      sign += (c.a[v] < 0 && c.b[v] > 0) || (c.a[v] > 0 && c.b[v] < 0) ? w[v] : 0;
    }
    CHECK(metrics_of(*engine, c).sign_change_area_fraction == doctest::Approx(sign / area).epsilon(1e-6));
  }
}

TEST_CASE("excluded triangles and triangles with a NaN sample are not counted") {
  for (const auto& engine : back_ends()) {
    Random random(91);
    Case c = sphere_case(0, 0);
    for (std::size_t v = 0; v < c.a.size(); ++v) {
      c.a[v] = static_cast<float>(random.uniform(-3, 3));
      c.b[v] = static_cast<float>(random.uniform(-3, 3));
    }
    check_close(metrics_of(*engine, c), metrics_oracle(c));
    c.excluded.assign(c.mapped.triangles.size(), 0.0F);
    for (std::size_t t = 0; t < c.mapped.triangles.size(); t += 3) c.excluded[t] = 1.0F;
    check_close(metrics_of(*engine, c), metrics_oracle(c));
    for (std::size_t v = 0; v < c.a.size(); v += 50)
      (v % 100 == 0 ? c.a : c.b)[v] = std::numeric_limits<float>::quiet_NaN();
    const Metrics m = metrics_of(*engine, c);
    check_close(m, metrics_oracle(c));
    CHECK(m.area_A2 < area_oracle(c.mapped) * 0.66);
  }
}

TEST_CASE("without valid area every metric but the area is NaN") {
  for (const auto& engine : back_ends()) {
    const Metrics m = metrics_of(*engine, sphere_case(std::numeric_limits<double>::quiet_NaN(), 1));
    CHECK(m.area_A2 == 0);
    for (const double value : {m.mean_abs_difference, m.rms_difference, m.mean_signed_difference,
                               m.sign_change_area_fraction, m.hodgkin_index, m.carbo_index, m.mean_displacement_A}) {
      CHECK(std::isnan(value));
    }
  }
}

TEST_CASE("weights and displacement are those of the mapped mesh") {
  for (const auto& engine : back_ends()) {
    // project() maps a sphere of radius 3 onto one of another radius and keeps the topology.
    const double r = 2.5 * std::sqrt(2 * std::log(2.0));
    Case c;
    c.source = icosphere(3, 3.0);
    const auto source = engine->upload_mesh(c.source);
    const auto mapped = engine->project(source, upload(*engine, one_gaussian({0.1, 0, 0}, 2.5)), 0.5F, 0.5);
    c.mapped = engine->download(mapped);
    Random random(92);
    for (std::size_t v = 0; v < c.source.positions.size(); ++v) {
      c.a.push_back(static_cast<float>(random.uniform(-1, 1)));
      c.b.push_back(static_cast<float>(random.uniform(-1, 1)));
    }
    const Metrics m = engine->compare(source, mapped, scalars(*engine, c.a), scalars(*engine, c.b), nullptr);
    check_close(m, metrics_oracle(c));
    CHECK(m.mean_displacement_A == doctest::Approx(3 - r).epsilon(0.2));
    CHECK(m.mean_displacement_A > 0.01);
    CHECK(engine->area(mapped) == doctest::Approx(area_oracle(c.mapped)).epsilon(1e-6));
  }
}

TEST_CASE("compare refuses other topologies and other numbers of samples") {
  for (const auto& engine : back_ends()) {
    const auto a = engine->upload_mesh(icosphere(2, 3.0)), b = engine->upload_mesh(icosphere(2, 3.0));
    const auto samples = scalars(*engine, std::vector<float>(162, 1.0F)),
               few = scalars(*engine, std::vector<float>(42, 1.0F));
    CHECK(message_of([&] { engine->compare(a, a, samples, few, nullptr); }) ==
          "compare: needs one potential per vertex of the mapped mesh");
    CHECK(message_of([&] { engine->compare(a, b, samples, samples, nullptr); }) ==
          "compare: source and mapped mesh differ in topology");
    CHECK_THROWS_AS(engine->compare(a, b, samples, samples, nullptr), espdiff::InputError);
  }
}

TEST_CASE("an exclusion list of the wrong length is refused") {
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(icosphere(2, 3.0));
    const auto samples = scalars(*engine, std::vector<float>(162, 1.0F)),
               few = scalars(*engine, std::vector<float>(42, 0.0F));
    CHECK_THROWS_AS(engine->compare(mesh, mesh, samples, samples, few), espdiff::InputError);
  }
}

TEST_SUITE_END();
