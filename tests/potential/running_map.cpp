// running_map.cpp: running mean, variance and error bar against the sums over all frames at once.
#include "potential/running_map.h"

#include <cmath>

#include "base/error.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::RunningMap;

namespace {

/// Frames of 2 x 3 x 4 points around a large mean.
std::vector<Grid> random_frames(std::size_t n, double mean) {
  Random random(50);
  std::vector<Grid> frames;
  for (std::size_t f = 0; f < n; ++f) {
    Grid grid;
    grid.lattice.size = {2, 3, 4};
    grid.lattice.step = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    grid.unit = espdiff::PotentialUnit::kKtPerE;
    grid.name = "frame";
    for (int i = 0; i < 24; ++i) grid.values.push_back(static_cast<float>(mean + random.uniform(-1, 1)));
    frames.push_back(grid);
  }
  return frames;
}

struct Moments {
  double mean = 0, variance = 0;
};
Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size() - 1);
  return m;
}

}  // namespace

TEST_SUITE_BEGIN("running_map");

TEST_CASE("mean, variance and standard error agree with two passes over all frames") {
  constexpr std::size_t kFrames = 23, kBlock = 4, kBlocks = 5;
  for (const double mean : {0.0, 1000.0}) {
    const std::vector<Grid> frames = random_frames(kFrames, mean);
    RunningMap running(kBlock);
    for (const Grid& frame : frames) running.add(frame);
    CHECK(running.n_frames() == kFrames);
    CHECK(running.n_blocks() == kBlocks);
    for (std::size_t p = 0; p < 24; ++p) {
      std::vector<double> values, block_means;
      for (const Grid& frame : frames) values.push_back(static_cast<double>(frame.values[p]));
      for (std::size_t b = 0; b < kBlocks; ++b)
        block_means.push_back(moments({values.begin() + b * kBlock, values.begin() + (b + 1) * kBlock}).mean);
      const Moments all = moments(values), blocks = moments(block_means);
      CHECK(static_cast<double>(running.mean().values[p]) == doctest::Approx(all.mean).epsilon(1e-6));
      CHECK(static_cast<double>(running.variance().values[p]) == doctest::Approx(all.variance).epsilon(1e-6));
      CHECK(static_cast<double>(running.standard_error().values[p]) ==
            doctest::Approx(std::sqrt(blocks.variance / kBlocks)).epsilon(1e-6));
    }
    CHECK(running.mean().unit == espdiff::PotentialUnit::kKtPerE);
    CHECK(running.variance().unit == espdiff::PotentialUnit::kUnknown);
  }
}

TEST_CASE("too few frames, other lattices and empty maps are refused") {
  RunningMap running(2);
  const std::vector<Grid> frames = random_frames(3, 0);
  CHECK_THROWS_AS(RunningMap(0), espdiff::InputError);
  CHECK(message_of([&] { running.mean(); }) == "the mean of no frames; add at least one");
  CHECK_THROWS_AS(running.add(Grid()), espdiff::InputError);
  running.add(frames[0]);
  CHECK(message_of([&] { running.variance(); }) == "the variance of 1 frames; at least 2 are needed");
  Grid other = frames[1];
  other.lattice.origin.x = 1;
  CHECK(message_of([&] { running.add(other); }).find("frame: the lattice or unit differs") == 0);
  running.add(frames[1]);
  running.add(frames[2]);
  CHECK(message_of([&] { running.standard_error(); }).find("from 1 whole blocks of 2 frames; at least 2") !=
        std::string::npos);
}

TEST_SUITE_END();
