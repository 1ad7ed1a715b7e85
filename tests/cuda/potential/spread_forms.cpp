// spread_forms.cpp: charges spread by slabs and by points give the same bits, and agree with a slow sum. Compiled with
// the CPU back end's flags, because the engine's interface offers neither.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "cuda/potential/spread.h"
#include "support/random.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;

namespace {

std::vector<GridCharge> random_grid_charges(std::array<int, 3> size, std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<GridCharge> charges(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double u = random.uniform(0, size[axis]);
      if (i % 5 == 0) u = std::floor(u);  // on grid points, too
      if (i % 11 == 0) u = i % 2 == 0 ? 0 : std::nextafter(static_cast<double>(size[axis]), 0);
      charges[i].u[axis] = u;
    }
    charges[i].charge = static_cast<float>(random.uniform(-1, 1));
  }
  return charges;
}

template <typename T>
std::size_t n_different(std::array<int, 3> size, int order, std::size_t n, std::uint64_t seed) {
  const auto sorted = sort_charges<T>(to_device(random_grid_charges(size, n, seed)), size, order);
  const std::size_t slab = static_cast<std::size_t>(size[0] * size[1]), stride = slab + 5;
  std::vector<T> a(stride * static_cast<std::size_t>(size[2])), b(a.size());
  spread_by_slabs(sorted, a.data(), stride);
  spread_by_points(sorted, b.data(), stride);
  std::size_t n_other = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n_other += a[i] == b[i] ? 0 : 1;
  return n_other;
}

}  // namespace

TEST_SUITE_BEGIN("spread");

TEST_CASE("slabs and points give the same bits for all orders, precisions and sizes down to the order") {
  for (int order = 4; order <= 8; ++order) {
    for (const auto& size : {std::array<int, 3>{order, order, order}, {9, 8, 11}, {16, 20, 12}, {33, 9, 21}}) {
      CAPTURE(order);
      CAPTURE(size[0]);
      CHECK(n_different<float>(size, order, 300, 5) == 0);
      CHECK(n_different<double>(size, order, 300, 6) == 0);
    }
  }
}

TEST_CASE("a spread charge sums to the charge, around its position") {
  for (int order = 4; order <= 8; ++order) {
    const std::array<int, 3> size{20, 21, 22};
    GridCharge charge{{7.3, 9.8, 10.0}, 1.5F, 0, 0};
    const auto sorted = sort_charges<double>(to_device(std::vector<GridCharge>{charge}), size, order);
    std::vector<double> values(20 * 21 * 22);
    spread_by_slabs(sorted, values.data(), 20 * 21);
    double sum = 0, mean[3] = {0, 0, 0};
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum += values[i];
      mean[0] += values[i] * static_cast<double>(i % 20);
      mean[1] += values[i] * static_cast<double>(i / 20 % 21);
      mean[2] += values[i] * static_cast<double>(i / 420);
    }
    CAPTURE(order);
    CHECK(sum == doctest::Approx(1.5).epsilon(1e-14));
    for (int axis = 0; axis < 3; ++axis) CHECK(mean[axis] / sum == doctest::Approx(charge.u[axis]).epsilon(1e-13));
  }
}

TEST_CASE("weights of order 4 halfway between two points are 1, 23, 23 and 1 of 48") {
  double weight[4];
  spline_weights<4>(0.5, weight);
  CHECK(weight[0] == doctest::Approx(1.0 / 48));
  CHECK(weight[1] == doctest::Approx(23.0 / 48));
  CHECK(weight[2] == doctest::Approx(23.0 / 48));
  CHECK(weight[3] == doctest::Approx(1.0 / 48));
}

TEST_CASE("coordinates are wrapped into the cell") {
  CHECK(wrapped(-0.25, 10) == 9.75);
  CHECK(wrapped(10.0, 10) == 0.0);
  CHECK(wrapped(123.5, 10) == 3.5);
  CHECK(wrapped(-1e-18, 10) == 0.0);
  for (int order = 4; order <= 8; ++order) {
    for (const double u : {0.0, 1e-17, 0.5, 4.999999, std::nextafter(10.0, 0.0)}) {
      const SplinePlace place = spline_place(u, order, 10);
      CHECK(place.base >= 0);
      CHECK(place.base < 10);
      CHECK(place.part >= 0);
      CHECK(place.part <= 1);
    }
  }
}

TEST_SUITE_END();
