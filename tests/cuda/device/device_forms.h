// device_forms.h: checks of the parallel primitives against serial code and against Thrust. One body for both back
// ends: included by device_forms.cpp (CPU) and device_forms_cuda.cu.
#pragma once

#include <doctest/doctest.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "base/error.h"
#include "cuda/deform/deform_iteration.h"
#include "cuda/device/device.h"
#include "cuda/device/spatial_order.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND::forms {

constexpr std::size_t kSizes[] = {0, 1, 2, 127, 128, 129, 2047, 2048, 2049, 4097, 100003};

/// Reproducible numbers.
inline std::vector<std::uint32_t> numbers(std::size_t n) {
  std::vector<std::uint32_t> all(n);
  std::uint32_t state = 12345;
  for (std::uint32_t& value : all) value = (state = state * 1664525U + 1013904223U) >> 8;
  return all;
}

inline void check_buffers() {
  for (const std::size_t n : kSizes) {
    CAPTURE(n);
    const std::vector<std::uint32_t> host = numbers(n);
    Buffer<std::uint32_t> buffer = to_device(host);
    CHECK(to_host(buffer) == host);
    const Buffer<std::uint32_t> copy = buffer;
    buffer.assign(n + 3, 7U);
    CHECK(to_host(buffer) == std::vector<std::uint32_t>(n + 3, 7U));
    CHECK(to_host(copy) == host);
    Buffer<std::uint32_t> grown = copy;
    grown.resize(2 * n + 1, 9U);
    std::vector<std::uint32_t> expected = host;
    expected.resize(2 * n + 1, 9U);
    CHECK(to_host(grown) == expected);
    CHECK(grown.back() == 9U);
    if (n > 0) CHECK(grown[n / 2] == host[n / 2]);
    grown.resize(n);
    CHECK(to_host(grown) == host);
    Buffer<std::uint32_t> moved = std::move(grown);
    CHECK(to_host(moved) == host);
    moved.swap(buffer);
    CHECK(to_host(buffer) == host);
    CHECK(moved.size() == n + 3);
    moved = copy;
    CHECK(to_host(moved) == host);
  }
}

/// More than any staging area holds, to the device and back.
inline void check_large_transfers() {
  const std::vector<std::uint32_t> large = numbers(3000001), small = numbers(1000);
  const Buffer<std::uint32_t> a = to_device(large), b = to_device(small);
  std::vector<Buffer<std::uint32_t>> many;
  for (std::uint32_t i = 0; i < 2000; ++i) many.push_back(to_device(std::vector<std::uint32_t>(1000, i)));
  CHECK(to_host(a) == large);
  CHECK(to_host(b) == small);
  for (std::uint32_t i = 0; i < 2000; i += 100) CHECK(to_host(many[i]) == std::vector<std::uint32_t>(1000, i));
}

struct Square {
  const std::uint32_t* from;
  std::uint32_t* to;
  ESPDIFF_HD void operator()(std::size_t i) const { to[i] = from[i] * from[i] + static_cast<std::uint32_t>(i); }
};

inline void check_for_each() {
  for (const std::size_t n : kSizes) {
    CAPTURE(n);
    const std::vector<std::uint32_t> host = numbers(n);
    const Buffer<std::uint32_t> in = to_device(host);
    Buffer<std::uint32_t> own(n), of_thrust(n);
    for_each_index(n, Square{raw(in), raw(own)});
    thrust::for_each_n(on_device(), thrust::counting_iterator<std::size_t>(0), n, Square{raw(in), raw(of_thrust)});
    std::vector<std::uint32_t> expected(n);
    for (std::size_t i = 0; i < n; ++i) Square{host.data(), expected.data()}(i);
    CHECK(to_host(own) == expected);
    CHECK(to_host(of_thrust) == expected);
  }
}

struct Sums {
  double value = 0;
  std::uint64_t count = 0;
  ESPDIFF_HD Sums& operator+=(const Sums& o) {
    value += o.value;
    count += o.count;
    return *this;
  }
};
struct RootOf {
  const std::uint32_t* from;
  ESPDIFF_HD Sums operator()(std::size_t i) const {
    Sums s;
    s.value = 1.0 / (1.0 + static_cast<double>(from[i]));
    s.count = from[i];
    return s;
  }
};

inline void check_sums() {
  for (const std::size_t n : kSizes) {
    CAPTURE(n);
    const std::vector<std::uint32_t> host = numbers(n);
    const Buffer<std::uint32_t> in = to_device(host);
    const Sums sum = sum_over<Sums>(n, RootOf{raw(in)}), again = sum_over<Sums>(n, RootOf{raw(in)});
    CHECK(std::memcmp(&sum.value, &again.value, sizeof sum.value) == 0);
    Sums expected;
    for (std::size_t i = 0; i < n; ++i) expected += RootOf{host.data()}(i);
    CHECK(sum.count == expected.count);
    CHECK(std::abs(sum.value - expected.value) <= 1e-14 * expected.value * std::sqrt(static_cast<double>(n) + 1));
  }
}

inline void check_running_sums() {
  for (const std::size_t n : kSizes) {
    CAPTURE(n);
    std::vector<std::uint32_t> host = numbers(n);
    for (std::uint32_t& value : host) value %= 10;
    Buffer<std::uint32_t> counts = to_device(host);
    const std::uint32_t total = exclusive_scan_in_place(counts);
    CHECK(total == std::accumulate(host.begin(), host.end(), 0U));
    std::vector<std::uint32_t> expected(n);
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < n; ++i) {
      expected[i] = before;
      before += host[i];
    }
    CHECK(to_host(counts) == expected);
  }
}

/// Sorting and selecting by Thrust, in the engine's memory and stream order.
inline void check_sorting() {
  const std::size_t n = 30000;
  const std::vector<std::uint32_t> random = numbers(3 * n);
  std::vector<Vec4f> points(n);
  const auto coordinate = [&](std::size_t i) { return static_cast<float>(random[i] % 100000) * 1e-3F; };
  for (std::size_t i = 0; i < n; ++i) points[i] = {coordinate(3 * i), coordinate(3 * i + 1), coordinate(3 * i + 2), 0};
  Buffer<std::uint32_t> order = spatial_order(to_device(points));
  std::vector<std::uint32_t> all = to_host(order), expected(n);
  CHECK(to_host(spatial_order(to_device(points))) == all);
  std::vector<std::uint8_t> done(n);
  for (std::size_t i = 0; i < n; ++i) done[i] = random[i] % 3 == 0 ? 1 : 0;
  const std::size_t left = drop_done(order, n, to_device(done));
  expected.clear();
  for (const std::uint32_t i : all) {
    if (done[i] == 0) expected.push_back(i);
  }
  order.resize(left);
  CHECK(to_host(order) == expected);
  std::sort(all.begin(), all.end());
  std::vector<std::uint32_t> whole(n);
  std::iota(whole.begin(), whole.end(), 0U);
  CHECK(all == whole);
}

/// A tetrahedron whose faces are divided n times, inflated to a bumpy ball.
inline SurfaceMesh bumpy_ball(int n) {
  std::vector<Vec3f> points = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  std::vector<Corners> triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
  for (; n > 0; --n) {
    std::vector<std::array<std::uint32_t, 3>> middles;  // low, high, middle
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const std::uint32_t low = std::min(a, b), high = std::max(a, b);
      for (auto m = middles.rbegin(); m != middles.rend(); ++m) {
        if ((*m)[0] == low && (*m)[1] == high) return (*m)[2];
      }
      points.push_back(0.5F * (points[a] + points[b]));
      middles.push_back({low, high, static_cast<std::uint32_t>(points.size() - 1)});
      return middles.back()[2];
    };
    std::vector<Corners> finer;
    for (const Corners& t : triangles) {
      const std::uint32_t a = between(t.v[0], t.v[1]), b = between(t.v[1], t.v[2]), c = between(t.v[2], t.v[0]);
      for (const Corners& part :
           {Corners{{t.v[0], a, c}}, Corners{{t.v[1], b, a}}, Corners{{t.v[2], c, b}}, Corners{{a, b, c}}})
        finer.push_back(part);
    }
    triangles = finer;
  }
  std::vector<Vec4f> placed;
  for (const Vec3f& p : points) {
    const Vec3f unit = (1.0F / norm(p)) * p;
    placed.push_back(make_vec4((5.0F + 0.5F * std::sin(4.0F * unit.x) * unit.y) * unit, 0.0F));
  }
  SurfaceMesh mesh;
  mesh.positions = to_device(placed);
  mesh.topology = make_topology(placed.size(), to_device(triangles));
  return mesh;
}

/// The distance to a ball of radius 6 on a lattice, positive inside.
inline SurfaceField ball_field() {
  SurfaceField field;
  field.lattice = {{24, 24, 24}, {-11.5F, -11.5F, -11.5F}, 1.0F};
  std::vector<Vec4f> values;
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 24; ++i) {
        const Vec3f p = field.lattice.point(i, j, k);
        const float r = norm(p);
        values.push_back(make_vec4((-1.0F / r) * p, 6.0F - r));
      }
    }
  }
  field.values = to_device(values);
  return field;
}

/// deform() as the back end runs it against single iterations, to the bit, with its report.
inline void check_deform() {
  const SurfaceMesh mesh = bumpy_ball(5);
  const SurfaceField field = ball_field();
  const std::size_t n = mesh.n_vertices();
  for (const int max_iterations : {0, 1, 4, 5, 19, 20, 21, 40, 57, 200, 1000}) {
    CAPTURE(max_iterations);
    DeformOptions options;
    options.max_iterations = max_iterations;
    options.min_displacement_A = 3e-4;
    DeformReport report, expected_report;
    const auto deformed = deform(mesh, mesh, field, options, "deform", {}, &report);

    DeformState state;
    state.positions = mesh.positions;
    state.moved.resize(n);
    Buffer<Vec4f> laplacians(n), rest(n, Vec4f{});
    Buffer<float> path_lengths(n, 0.0F), strengths(n, -1.0F);  // all vertices lie inside the ball
    Iteration& it = state.iteration;
    it.topology = mesh.view();
    it.lattice = field.lattice;
    it.field = raw(field.values);
    it.laplacian = raw(laplacians);
    it.rest = raw(rest);
    it.path_length = raw(path_lengths);
    it.strength = raw(strengths);
    set_steps(it, options);
    iterate_one_by_one(state, options, "deform", {}, expected_report);
    CHECK(report.iterations == expected_report.iterations);
    CHECK(report.converged == expected_report.converged);
    CHECK(report.mean_displacement_A == expected_report.mean_displacement_A);
    const std::vector<Vec4f> x = to_host(deformed->positions), expected = to_host(state.positions);
    CHECK(std::memcmp(x.data(), expected.data(), n * sizeof(Vec4f)) == 0);
    if (max_iterations <= 21) CHECK(!report.converged);
    if (max_iterations == 1000) CHECK(report.converged);
  }
}

/// All checks, as subcases of one test.
inline void check_all() {
  SUBCASE("buffers hold what they are given") { check_buffers(); }
  SUBCASE("transfers larger than the staging area, and many small ones") { check_large_transfers(); }
  SUBCASE("a body for each index agrees with Thrust's") { check_for_each(); }
  SUBCASE("sums agree with serial ones and repeat to the bit") { check_sums(); }
  SUBCASE("prefix sums") { check_running_sums(); }
  SUBCASE("sorting and selecting") { check_sorting(); }
  SUBCASE("iterations of deform, however they are launched") { check_deform(); }
}

}  // namespace espdiff::ESPDIFF_BACKEND::forms
