// lanes_forms.cpp: what lanes of points share, against the forms for one point and against the library's.
#include "cuda/device/lanes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "cuda/surface/density/point_sums.h"

using namespace espdiff::cpu_backend;

TEST_CASE("the exponential: relative error near 0 and far from it, 1 at 0, and the same bits in lanes and halved") {
  CHECK(exp_of_negative(0.0F) == 1.0F);
  for (int i = 1; i <= 200000; ++i) {
    const float x = -80.0F * static_cast<float>(i) / 200000.0F;
    const double exact = std::exp(static_cast<double>(x));
    // x log2(e) and log2(e) are rounded to floats.
    const double most = 2e-7 + 7.5e-8 * std::fabs(static_cast<double>(x));
    if (std::fabs(static_cast<double>(exp_of_negative(x)) / exact - 1) > most) FAIL_CHECK("at " << x);
  }
  for (int i = 0; i < 10000; ++i) {
    Lanes x, whole, half;
    for (std::size_t lane = 0; lane < kBlock; ++lane) x[lane] = -0.0010125F * static_cast<float>(8 * i) - 1e-5F * lane;
    exp_of_negative_lanes(1.0F, x, whole);
    exp_of_negative_lanes(0.5F, x, half);
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
      const float expected[2] = {exp_of_negative(x[lane]), exp_of_negative(0.5F * x[lane])};
      const float found[2] = {whole[lane], half[lane]};
      if (x[lane] >= -80.0F && std::memcmp(expected, found, sizeof found) != 0) FAIL_CHECK("at " << x[lane]);
    }
  }
}

TEST_CASE("the places of ones are those that a loop over bits finds, by words of 8 and of 16") {
  constexpr std::size_t kMost = 1024;
  std::uint32_t state = 7;
  const auto next = [&] { return (state = state * 1664525U + 1013904223U) >> 8; };
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint16_t> expected;
    PlacesOfOnes<kMost> narrow, wide;
    for (std::size_t first = 0; first < kMost; first += kWideBlock) {
      const std::uint32_t bits = (round == 0 ? 0xFFFFU : round == 1 ? 0U : next() & next() & 0xFFFFU);
      for (std::size_t k = 0; k < kWideBlock; ++k)
        if ((bits >> k & 1U) != 0) expected.push_back(static_cast<std::uint16_t>(first + k));
      wide.append<kWideBlock>(bits, first);
      narrow.append<kBlock>(bits & 0xFFU, first);
      narrow.append<kBlock>(bits >> 8U, first + kBlock);
    }
    CHECK(std::vector<std::uint16_t>(wide.places, wide.places + wide.n) == expected);
    CHECK(std::vector<std::uint16_t>(narrow.places, narrow.places + narrow.n) == expected);
  }
}
