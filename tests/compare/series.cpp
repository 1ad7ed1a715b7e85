// series.cpp: many targets with one source: the same as one by one, the start of each step, and the saved state.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "compare/built_molecule.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/files/sha256.h"
#include "options/options.h"
#include "support/test_data.h"
#include "trajectory/series_file.h"

using namespace espdiff_test;
using espdiff::Method;
using espdiff::Series;
using espdiff::SeriesState;
using espdiff::StartFrom;

namespace {

/// The molecule bent by an amount: the frames of a motion.
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
    for (const double amount : {2.0, 3.0, 4.5, 6.0}) frames.push_back(bent(source, amount));
  }
};

CompareOptions options_of(Method method) {
  CompareOptions options = quick_options();
  options.method = method;
  return options;
}
CompareOptions deform_options() { return options_of(Method::kDeform); }

/// The end of a state file.
std::string with_hash(const std::string& bytes) { return bytes + espdiff::sha256_of(bytes); }

std::unique_ptr<espdiff::Engine> one_engine() { return espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2); }

}  // namespace

TEST_SUITE_BEGIN("series");

TEST_CASE("steps that start from the source give the same bits as comparisons one by one") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), quick_options());
  for (const Side& frame : motion.frames) {
    const CompareResult step = series.step(frame.input(), StartFrom::kSource, {});
    CHECK(step.mapping.start == StartFrom::kSource);
    CHECK(hash_of(step) == hash_of(compare(*engine, motion.source.input(), frame.input(), quick_options(), {})));
  }
}

TEST_CASE("a surface continued from frame to frame by the morph ends where the direct mapping ends") {
  const Motion motion;
  const auto engine = one_engine();
  Series along(*engine, motion.source.input(), quick_options()), apart(*engine, motion.source.input(), quick_options());
  int n_along = 0, n_apart = 0;
  for (std::size_t f = 0; f < motion.frames.size(); ++f) {
    CAPTURE(f);
    const CompareResult on = along.step(motion.frames[f].input(), StartFrom::kPrevious, {});
    const CompareResult direct = apart.step(motion.frames[f].input(), StartFrom::kSource, {});
    CHECK(on.mapping.start == (f == 0 ? StartFrom::kSource : StartFrom::kPrevious));
    CHECK(on.certificate.mapped_to_target.mean < 0.02);
    CHECK(on.certificate.self_intersecting_pairs == 0);
    CHECK(on.certificate.unmatched_source < 0.02);
    CHECK(on.potential.metrics.mean_signed_difference ==
          doctest::Approx(direct.potential.metrics.mean_signed_difference).epsilon(0.05));
    CHECK(on.potential.metrics.mean_path_length_A >= on.potential.metrics.mean_displacement_A);
    // Vertices of the source's own surface come first in both.
    const std::size_t n = on.source_surface.n_vertices;
    REQUIRE(std::min(on.surface.positions.size(), direct.surface.positions.size()) >= n);
    double sum = 0;
    std::size_t n_both = 0;
    for (std::size_t v = 0; v < n; ++v) {
      CHECK(norm(on.surface.source_positions[v] - direct.surface.source_positions[v]) < 1e-6);
      if (std::isnan(on.surface.displacement[v]) || std::isnan(direct.surface.displacement[v])) continue;
      sum += norm(on.surface.positions[v] - direct.surface.positions[v]);
      ++n_both;
    }
    CHECK(n_both > n * 9 / 10);
    CHECK(sum / static_cast<double>(n_both) < 0.01);
    n_along += on.mapping.morph.steps;
    n_apart += direct.mapping.morph.steps;
  }
  CHECK(n_along < n_apart);
}

TEST_CASE("the morph continued to the same target leaves the surface in place") {
  const Motion motion;
  const auto engine = one_engine();
  Series series(*engine, motion.source.input(), quick_options());
  const CompareResult once = series.step(motion.frames[1].input(), StartFrom::kPrevious, {});
  const CompareResult again = series.step(motion.frames[1].input(), StartFrom::kPrevious, {});
  CHECK(again.mapping.start == StartFrom::kPrevious);
  REQUIRE(again.surface.positions.size() == once.surface.positions.size());
  for (std::size_t v = 0; v < once.surface.positions.size(); ++v)
    CHECK(norm(once.surface.positions[v] - again.surface.positions[v]) < 0.02);  // some even out a little further
  CHECK(again.surface.unmatched == once.surface.unmatched);
}

TEST_CASE(
    "surface lost by the morph stays lost in the next step, and after too much loss the step starts from the source") {
  const auto apart = [](double distance) {
    Builder b;
    b.add_ball(1, {0, 0, 0}, 6);
    b.add_ball(2, {distance, 0, 0}, 6);
    return b.molecule;
  };
  const auto engine = one_engine();
  const espdiff::Molecule source = apart(19);
  Series series(*engine, {&source, nullptr}, quick_options());
  const auto step = [&](double distance) {
    const espdiff::Molecule target = apart(distance);
    return series.step({&target, nullptr}, StartFrom::kPrevious, {});
  };
  double closed = 2.1;  // amount
  double lost = step(19 - closed).certificate.unmatched_source;
  const double at_start = lost;
  while (lost <= at_start + 0.005 && closed < 10) {
    closed *= 1.8;  // the last target is then less than half as far as the source
    const CompareResult next = step(19 - closed);
    CHECK(next.mapping.start == StartFrom::kPrevious);
    CHECK(next.certificate.unmatched_source >= lost - 1e-4);
    lost = next.certificate.unmatched_source;
  }
  REQUIRE(lost > at_start + 0.005);
  const CompareResult anew = step(18.5 - closed);
  CHECK(anew.mapping.start == StartFrom::kSource);
  const espdiff::Molecule target = apart(18.5 - closed);
  CHECK(hash_of(anew) == hash_of(compare(*engine, {&source, nullptr}, {&target, nullptr}, quick_options(), {})));
}

TEST_CASE("rigid domains continue from frame to frame too") {
  const Motion motion;
  const auto engine = one_engine();
  CompareOptions options = quick_options();
  options.domains = "1-6/7-12";
  Series along(*engine, motion.source.input(), options), apart(*engine, motion.source.input(), options);
  for (const std::size_t f : {0, 1, 2}) {
    const CompareResult on = along.step(motion.frames[f].input(), StartFrom::kPrevious, {});
    const CompareResult direct = apart.step(motion.frames[f].input(), StartFrom::kSource, {});
    CHECK(on.alignment.domains.size() == 2);
    CHECK(on.certificate.mapped_to_target.mean < 0.02);
    CHECK(on.potential.metrics.mean_displacement_A ==
          doctest::Approx(direct.potential.metrics.mean_displacement_A).epsilon(0.1));
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
    CHECK(warm.mapping.start == (f == 0 ? StartFrom::kSource : StartFrom::kPrevious));
    n_along += warm.mapping.deform.iterations;
    n_apart += cold.mapping.deform.iterations;
    CHECK(warm.certificate.mapped_to_target.mean < 0.05);
    CHECK(warm.certificate.corrupt_area_fraction <= cold.certificate.corrupt_area_fraction + 0.002);
    CHECK(warm.potential.metrics.mean_signed_difference ==
          doctest::Approx(cold.potential.metrics.mean_signed_difference).epsilon(0.05));
  }
  CHECK(n_along < n_apart);
}

TEST_CASE("a step starts from the source if the previous target is farther away than the source") {
  const Motion motion;
  const auto engine = one_engine();
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    Series series(*engine, motion.source.input(), options_of(method));
    series.step(motion.frames[3].input(), StartFrom::kPrevious, {});
    CHECK(series.step(bent(motion.source, 0.3).input(), StartFrom::kPrevious, {}).mapping.start == StartFrom::kSource);
  }
}

TEST_CASE("a step that failed leaves the series usable, and the next one starts from the source") {
  const Motion motion;
  const auto engine = one_engine();
  Side elsewhere = motion.frames[1];
  elsewhere.map.lattice.origin += Vec3d{500, 0, 0};
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    Series series(*engine, motion.source.input(), options_of(method));
    const auto starts_anew = [&] {
      CHECK_FALSE(series.state().has_value());
      return series.step(motion.frames[1].input(), StartFrom::kPrevious, {}).mapping.start == StartFrom::kSource;
    };
    series.step(motion.frames[0].input(), StartFrom::kPrevious, {});
    CHECK_THROWS_AS(series.step(motion.frames[1].shape(), StartFrom::kPrevious, {}), espdiff::InputError);
    CHECK(starts_anew());
    espdiff::Progress cancelled;
    cancelled.request_cancel();
    CHECK_THROWS_AS(series.step(motion.frames[1].input(), StartFrom::kPrevious, cancelled), espdiff::Cancelled);
    CHECK(starts_anew());
    CHECK_THROWS_AS(series.step(elsewhere.input(), StartFrom::kPrevious, {}), espdiff::InputError);
    CHECK(starts_anew());
  }
}

TEST_CASE("a series restored from its saved state gives the same bits") {
  const Motion motion;
  const ScratchFolder folder;
  const std::string path = folder.file("run.state");
  const auto engine = one_engine();
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    CAPTURE(to_string(method));
    Series whole(*engine, motion.source.input(), options_of(method));
    CHECK_FALSE(whole.state().has_value());
    whole.step(motion.frames[0].input(), StartFrom::kPrevious, {});
    whole.step(motion.frames[1].input(), StartFrom::kPrevious, {});
    write_series_state(path, whole.state().value(), "run 1, frame 1");
    const CompareResult expected = whole.step(motion.frames[2].input(), StartFrom::kPrevious, {});
    REQUIRE(expected.mapping.start == StartFrom::kPrevious);

    Series resumed(*engine, motion.source.input(), options_of(method));
    resumed.restore(espdiff::read_series_state(path, "run 1, frame 1"));
    const CompareResult result = resumed.step(motion.frames[2].input(), StartFrom::kPrevious, {});
    CHECK(result.mapping.start == StartFrom::kPrevious);
    CHECK(hash_of(result) == hash_of(expected));
    CHECK(result.surface.unmatched == expected.surface.unmatched);
    // Also the state it would pass on.
    write_series_state(folder.file("expected"), whole.state().value(), "");
    write_series_state(folder.file("resumed"), resumed.state().value(), "");
    CHECK(read_file(folder.file("resumed")) == read_file(folder.file("expected")));
  }
}

TEST_CASE("a state that is nested deeper than ours is refused, before a parser recurses through it") {
  const ScratchFolder folder;
  // Arrays, texts, bytes and arrays of unknown length; a map, whose keys are empty texts: 2 MB used up 8 MB of stack.
  for (const std::string item : {"\x81", "\x7f", "\x5f", "\x9f", "\xa1\x60", "\xbf\x60", "\xc1"}) {
    std::string bytes;
    while (bytes.size() < 2'000'000) bytes += item;
    folder.write("state", bytes);
    CHECK(message_of([&] { espdiff::read_series_state(folder.file("state"), "run"); }) ==
          folder.file("state") +
              ": the saved state is damaged or cut off; delete it, and the run starts from the source");
  }
}

TEST_CASE("a state whose parts do not fit each other is refused, though its check sum fits") {
  const ScratchFolder folder;
  SeriesState good{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, 0}}, std::nullopt};
  SeriesState::Morph morph{
      good.mapped, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}, {0, 0, 0, 0}, {0, 0, 0, 0}, {}, 0, 0};
  morph.target.residues.push_back({"ALA", "A", 1, ' '});
  morph.target.atoms = {{"N", "N", 0, false}};
  morph.target.positions = {{0, 0, 0}};
  morph.target.radii = {1.6F};
  good.morph = morph;
  const auto message = [&](const SeriesState& state) {
    write_series_state(folder.file("state"), state, "run");
    return message_of([&] { espdiff::read_series_state(folder.file("state"), "run"); });
  };
  CHECK(message(good) == "(nothing thrown)");
  std::vector<SeriesState> bad(7, good);
  bad[0].morph->triangles[2][1] = 4;
  bad[1].morph->unmatched.pop_back();
  bad[2].morph->path_length.push_back(0);
  bad[3].morph->target.atoms[0].residue = 1;
  bad[4].morph->target.atoms[0].residue = -1;
  bad[5].mapped[3].x = std::nanf("");
  bad[6].morph->target.positions.clear();
  for (const SeriesState& state : bad) CHECK(message(state).find("the saved state is damaged") != std::string::npos);
}

TEST_CASE("a state of another series, or a damaged one, is refused with the remedy") {
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
        }).find("is of another run; delete it, and the run starts from the source") != std::string::npos);
  CHECK(message_of([&] {
          espdiff::read_series_state(folder.file("absent"), "run 1");
        }).find("starts from the source") != std::string::npos);

  const std::string good = read_file(path);
  for (const std::string& bad : {good.substr(0, good.size() / 2), good.substr(0, 20), std::string(), good + "x"}) {
    folder.write("run.state", bad);
    CHECK(message_of([&] { espdiff::read_series_state(path, "run 1"); }).find("damaged or cut off") !=
          std::string::npos);
  }
  folder.write("run.state", with_hash("espdiff series state 1\nrun 1\n0123456789"));
  CHECK(message_of([&] {
          espdiff::read_series_state(path, "run 1");
        }).find("by another version of espdiff; delete it") != std::string::npos);
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
  Series by_morph(*engine, motion.source.input(), quick_options());
  by_morph.restore(state);
  CHECK(message_of([&] { by_morph.step(motion.frames[0].input(), StartFrom::kPrevious, {}); }) ==
        "the saved state is of the method deform, this series is by morph; start the series anew");
  state.target.resize(3);
  Series other(*engine, motion.source.input(), deform_options());
  CHECK(message_of([&] { other.restore(state); }) ==
        "the saved state is of a source with 3 atoms, this one has 120; start the series anew");
}

TEST_SUITE_END();
