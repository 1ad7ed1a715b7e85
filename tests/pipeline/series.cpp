// series.cpp: many targets with one source: the same as one by one, what a step starts from, and a state that survives.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "pipeline/made_side.h"
#include "pipeline/series_file.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Series;
using espdiff::SeriesState;
using espdiff::StartFrom;

namespace {

/// The molecule bent by so much: the frames of a motion.
Side bent(const Side& side, double amount) {
  Side result = side;
  for (Vec3d& p : result.molecule.positions) p.z += amount * 0.02 * p.x * p.x;
  result.map = potential_map(result.molecule, 1.0);
  return result;
}

struct Motion {
  Side source = make_side(1, 0);
  std::vector<Side> frames;
  Motion() {
    for (const double amount : {1.5, 3.0, 4.5, 6.0}) frames.push_back(bent(source, amount));
  }
};

/// Starts from the step before are deform's.
CompareOptions deform_options() {
  CompareOptions options = quick_options();
  options.method = espdiff::Method::kDeform;
  return options;
}

std::unique_ptr<espdiff::Engine> one_engine() { return espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2); }

}  // namespace

TEST_SUITE_BEGIN("series");

TEST_CASE("steps that start from the source give the same bits as comparisons one by one") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), quick_options());
  for (const Side& frame : motion.frames) {
    const CompareResult step = series.step(frame.input(), StartFrom::kSource, {});
    CHECK(step.start == StartFrom::kSource);
    CHECK(hash_of(step) == hash_of(compare(*engine, motion.source.input(), frame.input(), quick_options(), {})));
  }
}

TEST_CASE("the morph starts each step from the source, whatever is asked") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), quick_options());
  for (const Side& frame : {motion.frames[0], motion.frames[1]}) {
    const CompareResult step = series.step(frame.input(), StartFrom::kPrevious, {});
    CHECK(step.start == StartFrom::kSource);
    CHECK(hash_of(step) == hash_of(compare(*engine, motion.source.input(), frame.input(), quick_options(), {})));
    CHECK_FALSE(series.state().has_value());
  }
}

TEST_CASE("along a motion steps start from the previous one, need fewer iterations, and fit as well") {
  const Motion motion;
  const auto engine = one_engine();
  CompareOptions options = deform_options();
  options.deform.max_iterations = 3000;
  Series along(*engine, motion.source.input(), options), apart(*engine, motion.source.input(), options);
  int n_along = 0, n_apart = 0;
  for (std::size_t f = 0; f < motion.frames.size(); ++f) {
    const CompareResult warm = along.step(motion.frames[f].input(), StartFrom::kPrevious, {});
    const CompareResult cold = apart.step(motion.frames[f].input(), StartFrom::kSource, {});
    CHECK(warm.start == (f == 0 ? StartFrom::kSource : StartFrom::kPrevious));
    n_along += warm.deform_report.iterations;
    n_apart += cold.deform_report.iterations;
    CHECK(warm.certificate.mapped_to_target.mean < 0.05);
    CHECK(warm.certificate.corrupt_area_fraction <= cold.certificate.corrupt_area_fraction + 0.002);
    CHECK(warm.metrics.mean_signed_difference == doctest::Approx(cold.metrics.mean_signed_difference).epsilon(0.05));
  }
  CHECK(n_along < n_apart);
}

TEST_CASE("a step starts from the source when the previous target lies farther away than that") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), deform_options());
  series.step(motion.frames[3].input(), StartFrom::kPrevious, {});
  CHECK(series.step(bent(motion.source, 0.3).input(), StartFrom::kPrevious, {}).start == StartFrom::kSource);
}

TEST_CASE("a step that failed leaves the series usable, and the next one starts from the source") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), deform_options());
  series.step(motion.frames[0].input(), StartFrom::kPrevious, {});
  CHECK_THROWS_AS(series.step(motion.frames[1].shape(), StartFrom::kPrevious, {}), espdiff::InputError);
  espdiff::Progress cancelled;
  cancelled.request_cancel();
  CHECK_THROWS_AS(series.step(motion.frames[1].input(), StartFrom::kPrevious, cancelled), espdiff::Cancelled);
  Side elsewhere = motion.frames[1];
  elsewhere.map.lattice.origin += Vec3d{500, 0, 0};
  CHECK_THROWS_AS(series.step(elsewhere.input(), StartFrom::kPrevious, {}), espdiff::InputError);
  CHECK(series.step(motion.frames[1].input(), StartFrom::kPrevious, {}).start == StartFrom::kSource);
}

TEST_CASE("a series that goes on from its saved state gives the same bits") {
  const Motion motion;
  const ScratchFolder folder;
  const std::string path = folder.file("run.state");
  const auto engine = one_engine();
  Series whole(*engine, motion.source.input(), deform_options());
  CHECK_FALSE(whole.state().has_value());
  whole.step(motion.frames[0].input(), StartFrom::kPrevious, {});
  whole.step(motion.frames[1].input(), StartFrom::kPrevious, {});
  write_series_state(path, whole.state().value(), "run 1, frame 1");
  const CompareResult expected = whole.step(motion.frames[2].input(), StartFrom::kPrevious, {});
  REQUIRE(expected.start == StartFrom::kPrevious);

  Series resumed(*engine, motion.source.input(), deform_options());
  resumed.restore(espdiff::read_series_state(path, "run 1, frame 1"));
  const CompareResult result = resumed.step(motion.frames[2].input(), StartFrom::kPrevious, {});
  CHECK(result.start == StartFrom::kPrevious);
  CHECK(hash_of(result) == hash_of(expected));
}

TEST_CASE("a state of something else, or damaged, is refused with what to do") {
  const Motion motion;
  const ScratchFolder folder;
  const std::string path = folder.file("run.state");
  SeriesState state;
  state.mapped.resize(10);
  state.target.resize(motion.source.molecule.size());
  write_series_state(path, state, "run 1");
  CHECK(espdiff::read_series_state(path, "run 1").mapped.size() == 10);
  CHECK(message_of([&] {
          espdiff::read_series_state(path, "run 2");
        }).find("of another run (run 1 instead of run 2)") != std::string::npos);
  CHECK(message_of([&] {
          espdiff::read_series_state(folder.file("absent"), "run 1");
        }).find("starts from the source") != std::string::npos);

  const std::string good = read_file(path);
  for (const std::string& bad : {good.substr(0, good.size() / 2), good.substr(0, 20), std::string(), good + "x"}) {
    folder.write("run.state", bad);
    CHECK(message_of([&] { espdiff::read_series_state(path, "run 1"); }).find("damaged or cut off") !=
          std::string::npos);
  }
  std::string flipped = good;
  flipped[good.size() / 2] ^= 1;
  folder.write("run.state", flipped);
  CHECK_THROWS_AS(espdiff::read_series_state(path, "run 1"), espdiff::FormatError);

  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), deform_options());
  series.restore(state);
  CHECK(message_of([&] {
          series.step(motion.frames[0].input(), StartFrom::kPrevious, {});
        }).find("the saved state is of a surface with 10 vertices") == 0);
  state.target.resize(3);
  Series other(*engine, motion.source.input(), deform_options());
  CHECK(message_of([&] { other.restore(state); }) ==
        "the saved state is of a source with 3 atoms, this one has 120; start the series anew");
}

TEST_SUITE_END();
