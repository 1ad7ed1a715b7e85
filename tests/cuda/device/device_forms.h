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
#include "cuda/device/hilbert_curve.h"
#include "cuda/device/sort.h"
#include "cuda/device/spatial_order.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/mesh/components.h"
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

/// Keys at the limits of their range, and many equal ones: against std::stable_sort.
inline void check_sorting() {
  CHECK(bits_below(0) == 0);
  CHECK(bits_below(1) == 0);
  CHECK(bits_below(2) == 1);
  CHECK(bits_below(256) == 8);
  CHECK(bits_below(257) == 9);
  CHECK(bits_below(std::size_t{1} << 32) == 32);
  for (const int n_bits : {1, 2, 7, 8, 9, 16, 17, 30, 32}) {
    const std::uint32_t largest = 0xFFFFFFFFU >> (32 - n_bits);
    for (const std::size_t n : kSizes) {
      CAPTURE(n_bits);
      CAPTURE(n);
      std::vector<std::uint32_t> keys = numbers(n), index(n);
      for (std::size_t i = 0; i < n; ++i) keys[i] = i % 5 == 0 ? largest - keys[i] % 2 : (keys[i] * 257U) & largest;
      std::iota(index.begin(), index.end(), 0U);
      Buffer<std::uint32_t> sorted = to_device(keys), values = to_device(index);
      sort_by_key(sorted, values, n_bits);
      std::stable_sort(index.begin(), index.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
      CHECK(to_host(values) == index);
      std::sort(keys.begin(), keys.end());
      CHECK(to_host(sorted) == keys);
    }
  }
}

/// Rows of items against a count; empty rows at both ends and between, and items of no row.
inline void check_rows() {
  for (const std::size_t n_buckets : {0, 1, 2, 255, 256, 5000}) {
    for (const std::size_t n : kSizes) {
      CAPTURE(n_buckets);
      CAPTURE(n);
      std::vector<std::uint32_t> bucket = numbers(n);
      std::vector<std::vector<std::uint32_t>> expected(n_buckets + 1);
      for (std::size_t i = 0; i < n; ++i) {
        // The first and the last bucket stay empty where there are more than two.
        bucket[i] = i % 7 == 0 || n_buckets == 0 ? static_cast<std::uint32_t>(n_buckets)
                    : n_buckets < 3              ? bucket[i] % static_cast<std::uint32_t>(n_buckets)
                                                 : 1 + bucket[i] % static_cast<std::uint32_t>(n_buckets - 2);
        expected[bucket[i]].push_back(static_cast<std::uint32_t>(i));
      }
      const Rows rows = sort_into_rows(to_device(bucket), n_buckets);
      const std::vector<std::uint32_t> first = to_host(rows.first), item = to_host(rows.item);
      REQUIRE(first.size() == n_buckets + 1);
      REQUIRE(item.size() == n);
      std::vector<std::uint32_t> expected_first(1, 0), expected_item;
      for (const std::vector<std::uint32_t>& row : expected) {
        expected_item.insert(expected_item.end(), row.begin(), row.end());
        expected_first.push_back(static_cast<std::uint32_t>(expected_item.size()));
      }
      expected_first.pop_back();  // the end of the items of no row
      CHECK(first == expected_first);
      CHECK(item == expected_item);
    }
  }
}

/// Reads that wait together, more than the staging area holds; what was not waited for is dropped.
inline void check_reads() {
  const std::vector<std::uint32_t> host = numbers(700000);  // 2.7 MB
  const Buffer<std::uint32_t> buffer = to_device(host);
  std::vector<std::uint32_t> all[4];
  std::uint32_t first = 0, last = 0, untouched = 7;
  {
    HostReads reads;
    read_element(reads, first, buffer, 0);
    for (std::vector<std::uint32_t>& part : all) read_elements(reads, part, buffer, 3, host.size() - 3);
    const Buffer<std::uint32_t> other = to_device(host);  // also by the staging area
    read_element(reads, last, other, host.size() - 1);
    reads.wait();
  }
  CHECK(first == host.front());
  CHECK(last == host.back());
  for (const std::vector<std::uint32_t>& part : all)
    CHECK(part == std::vector<std::uint32_t>(host.begin() + 3, host.end()));
#if defined(ESPDIFF_BACKEND_CUDA)
  {
    HostReads reads;
    read_element(reads, untouched, buffer, 0);
  }
  CHECK(buffer.back() == host.back());  // waits
  CHECK(untouched == 7);
#else
  static_cast<void>(untouched);
#endif
}

/// The spatial order contains each index once, and repeats.
/// Of a lattice's cells each follows one that shares a face with it, and each has a place of its own.
inline void check_hilbert_curve() {
  constexpr std::size_t kEdge = 32, kCells = kEdge * kEdge * kEdge;
  Buffer<std::uint32_t> codes(kCells);
  std::uint32_t* const code = raw(codes);
  for_each_index(kCells, [=] ESPDIFF_HD(std::size_t i) {
    constexpr float kWidth = 1024.0F / kEdge;
    code[i] = hilbert_code({kWidth * static_cast<float>(i % kEdge), kWidth * static_cast<float>(i / kEdge % kEdge),
                            kWidth * static_cast<float>(i / kEdge / kEdge)});
  });
  constexpr int kBitsWithin = kHilbertBits - 15;
  const std::vector<std::uint32_t> places = to_host(codes);
  std::vector<std::size_t> at(kCells, kCells);
  for (std::size_t i = 0; i < kCells; ++i) at[places[i] >> kBitsWithin] = i;
  std::size_t n_steps = 0;
  for (std::size_t i = 0; i + 1 < kCells; ++i) {
    REQUIRE(at[i] < kCells);
    const std::size_t a = std::min(at[i], at[i + 1]), b = std::max(at[i], at[i + 1]);
    const bool is_row = b - a == 1 && b % kEdge != 0, is_plane = b - a == kEdge && b / kEdge % kEdge != 0;
    if (is_row || is_plane || b - a == kEdge * kEdge) ++n_steps;
  }
  CHECK(n_steps == kCells - 1);
}

inline void check_spatial_order() {
  const std::size_t n = 30000;
  const std::vector<std::uint32_t> random = numbers(3 * n);
  std::vector<Vec4f> points(n);
  const auto coordinate = [&](std::size_t i) { return static_cast<float>(random[i] % 100000) * 1e-3F; };
  for (std::size_t i = 0; i < n; ++i) points[i] = {coordinate(3 * i), coordinate(3 * i + 1), coordinate(3 * i + 2), 0};
  Buffer<std::uint32_t> order = spatial_order(to_device(points));
  std::vector<std::uint32_t> all = to_host(order);
  CHECK(to_host(spatial_order(to_device(points))) == all);
#if !defined(ESPDIFF_BACKEND_CUDA)
  std::vector<std::uint8_t> done(n);
  for (std::size_t i = 0; i < n; ++i) done[i] = random[i] % 3 == 0 ? 1 : 0;
  const std::size_t left = drop_done(order, n, to_device(done));
  std::vector<std::uint32_t> expected;
  for (const std::uint32_t i : all) {
    if (done[i] == 0) expected.push_back(i);
  }
  order.resize(left);
  CHECK(to_host(order) == expected);
#endif
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

/// Several balls whose vertices are shuffled together: numbers, sizes, areas and volumes of each.
inline void check_components() {
  const SurfaceMesh ball = bumpy_ball(4);
  const std::vector<Vec4f> x = to_host(ball.positions);
  const std::vector<Corners> triangles = to_host(ball.topology->triangles);
  constexpr std::size_t kBalls = 9;
  const std::vector<std::uint32_t> random = numbers(kBalls * x.size());
  std::vector<std::uint32_t> vertices(random.size()), place(random.size());
  std::iota(vertices.begin(), vertices.end(), 0U);
  std::sort(vertices.begin(), vertices.end(),
            [&](std::uint32_t a, std::uint32_t b) { return random[a] != random[b] ? random[a] < random[b] : a < b; });
  std::vector<Vec4f> positions(vertices.size());
  std::vector<std::uint32_t> ball_of(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    place[vertices[v]] = v;
    ball_of[v] = vertices[v] / static_cast<std::uint32_t>(x.size());
    positions[v] = (1.0F + 0.5F * static_cast<float>(ball_of[v])) * x[vertices[v] % x.size()];
  }
  std::vector<Corners> corners;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t b = 0; b < kBalls; ++b) {
      const auto corner = [&](int c) { return place[b * static_cast<std::uint32_t>(x.size()) + triangles[t].v[c]]; };
      corners.push_back({{corner(0), corner(1), corner(2)}});
    }
  }
  SurfaceMesh mesh;
  mesh.positions = to_device(positions);
  mesh.topology = make_topology(positions.size(), to_device(corners));
  const ComponentLabels labels = label_components(mesh);
  REQUIRE(labels.n_components == kBalls);
  // Numbered in the order of their first vertices.
  std::vector<std::uint32_t> number(kBalls, kBalls), expected(vertices.size());
  std::uint32_t n_seen = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (number[ball_of[v]] == kBalls) number[ball_of[v]] = n_seen++;
    expected[v] = number[ball_of[v]];
  }
  CHECK(to_host(labels.label) == expected);
  const std::vector<ComponentSummary> summaries = summarize_components(mesh, labels);
  REQUIRE(summaries.size() == kBalls);
  for (std::uint32_t b = 0; b < kBalls; ++b) {
    double area = 0, volume = 0;
    for (const Corners& t : corners) {
      if (ball_of[t.v[0]] != b) continue;
      const auto at = [&](int c) { return static_cast<Vec3d>(positions[t.v[c]].xyz()); };
      area += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
      volume += dot(at(0), cross(at(1), at(2))) / 6.0;
    }
    const ComponentSummary& s = summaries[number[b]];
    CHECK(s.n_vertices == x.size());
    CHECK(s.n_triangles == triangles.size());
    CHECK(s.area_A2 == doctest::Approx(area).epsilon(1e-12));
    CHECK(s.volume_A3 == doctest::Approx(volume).epsilon(1e-12));
  }
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
    options.momentum = max_iterations % 2 == 0 ? 0.7 : 0;
    DeformReport report, expected_report;
    const auto deformed = deform(mesh, mesh, field, options, "deform", {}, &report);

    DeformState state;
    state.positions = mesh.positions;
    state.moved = mesh.positions;
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
  SUBCASE("sorting by keys of as many bits as they need") { check_sorting(); }
  SUBCASE("rows of items by bucket") { check_rows(); }
  SUBCASE("reads that wait together") { check_reads(); }
  SUBCASE("spatial order") { check_spatial_order(); }
  SUBCASE("components, joined by threads in any order") { check_components(); }
  SUBCASE("iterations of deform, however they are launched") { check_deform(); }
}

}  // namespace espdiff::ESPDIFF_BACKEND::forms
