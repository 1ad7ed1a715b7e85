// choose_motions.cpp: which of two mappings is kept, that pairs which pass are untouched, and what a second mapping
// leaves in a series, in progress reports and after a cancellation.
#include "compare/choose_motions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "compare/series.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::MappedStep;
using espdiff::Progress;
using espdiff::Series;
using espdiff::StartFrom;

namespace {

/// States of which only the areas count: 100 and 300 A^2.
struct TwoAreas {
  std::unique_ptr<espdiff::Engine> engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  CompareOptions options;
  Molecule molecule;
  espdiff::Surface source, target;
  espdiff::MeshPtr none;
  espdiff::Alignment alignment;

  TwoAreas() {
    source.summary.area_A2 = 100;
    target.summary.area_A2 = 300;
  }
  espdiff::StatesToMap states() const {
    return {*engine, options, molecule, source, none, false, molecule, target, alignment};
  }
};

/// A mapping with nothing but numbers.
MappedStep step_of(const char* domains, double slipped, double same_residue, double unmatched = 0) {
  MappedStep step{};
  step.report.domains = domains;
  step.certificate.converged = true;
  step.certificate.slip.emplace();
  step.certificate.slip->large_area_fraction = slipped;
  step.certificate.same_residue_area_fraction = same_residue;
  step.certificate.unmatched_source = step.certificate.unmatched_target = unmatched;
  return step;
}

std::string kept(const MappedStep& straight, const MappedStep& local) {
  const TwoAreas areas;
  const MappedStep step = better_of(straight, local, areas.states());
  REQUIRE(step.report.other.has_value());
  CHECK(step.report.other->domains == (step.report.domains == "none" ? "local" : "none"));
  return step.report.domains;
}

double share_of(const CompareResult& r) {
  return own_residue_share(r.certificate, r.source_surface.area_A2, r.target_surface.area_A2);
}

/// On a coarse lattice, which is enough for the choice.
CompareOptions with(const std::string& domains) {
  CompareOptions options = quick_options();
  options.domains = domains;
  options.surface.grid_spacing_A = 1.6;
  return options;
}

/// Two models of a nucleocapsid, whose halves turn: the superposition of the whole maps little of it rightly.
struct Nucleocapsid {
  Molecule source, target;
  bool is_there = false;

  Nucleocapsid() {
    const auto path = real_input("pairs/1aaf.pdb");
    if (!path) return;
    espdiff::StructureOptions tenth;
    tenth.model = 10;
    source = espdiff::read_structure(*path, {});
    target = espdiff::read_structure(*path, tenth);
    is_there = true;
  }
  CompareResult compared(const CompareOptions& options, int threads = 2, const Progress& progress = {}) const {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, threads);
    return compare(*engine, {&source, nullptr}, {&target, nullptr}, options, progress);
  }
};

}  // namespace

TEST_SUITE_BEGIN("choose_motions");

TEST_CASE("a mapping within its limits is kept, then the one with more area on its own residue, then the first") {
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.03, 0.7)) == "local");
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.05, 0.81)) == "local");
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.05, 0.79)) == "none");
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.05, 0.8)) == "none");
  // 5 % slip is within the limit of the superposition, not of local motions; lost area is no gain.
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.05, 0.82, 0.04)) == "none");
  CHECK(kept(step_of("none", 0.10, 0.8), step_of("local", 0.01, 0.9, 0.06)) == "local");
}

TEST_CASE("the area on its own residue counts both surfaces, by their areas") {
  MappedStep step = step_of("none", 0.1, 0.5);
  step.certificate.unmatched_source = 0.2;
  step.certificate.unmatched_target = 0.4;
  CHECK(own_residue_share(step.certificate, 100, 300) == doctest::Approx(0.5 * (100 * 0.8 + 300 * 0.6) / 400));
}

TEST_CASE("the mapping that was not kept is described with its limits") {
  const TwoAreas areas;
  const MappedStep step = better_of(step_of("none", 0.125, 0.8), step_of("local", 0.03, 0.9), areas.states());
  const espdiff::OtherMapping& other = *step.report.other;
  CHECK(other.slip_area_fraction == 0.125);
  CHECK(other.same_residue_area_fraction == 0.8);
  CHECK(other.own_residue_area_fraction == doctest::Approx(0.8));
  REQUIRE(other.reasons.size() == 1);
  CHECK(other.reasons[0].plain() ==
        "12.5 % of the mapped area slipped by more than 3 A from its own atoms (limit 8 %)");
  CHECK(other.because == "the superposition of the whole slips, and local motions are within the limits");
  const MappedStep failed = without_second(step_of("none", 0.125, 0.8), "nothing remains");
  CHECK(failed.report.domains == "none");
  CHECK(failed.report.other->reasons[0].plain() == "nothing remains");
}

TEST_CASE("pairs that do not slip have the bits of the superposition, by either method") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  for (const espdiff::Method method : {espdiff::Method::kMorph, espdiff::Method::kDeform}) {
    CompareOptions options = quick_options();
    options.method = method;
    REQUIRE(options.domains == "as-needed");
    const CompareResult result = compare(*engine, a.input(), b.input(), options, {});
    CHECK(result.mapping.domains == "none");
    CHECK_FALSE(result.mapping.other.has_value());
    options.domains = "none";
    CHECK(hash_of(result) == hash_of(compare(*engine, a.input(), b.input(), options, {})));
  }
}

TEST_CASE("a pair that slips has the bits of local motions where they map better, at any number of threads") {
  const Nucleocapsid pair;
  if (!pair.is_there) return;
  const CompareResult result = pair.compared(with("as-needed")), straight = pair.compared(with("none"));
  CHECK(hash_of(result) == hash_of(pair.compared(with("local"))));
  CHECK(result.mapping.domains == "local");
  CHECK_FALSE(result.certificate.trustworthy);
  REQUIRE(result.mapping.other.has_value());
  const espdiff::OtherMapping& other = *result.mapping.other;
  CHECK(other.domains == "none");
  // The mapping that was not kept has longer steps.
  constexpr double kOfSteps = 0.02;
  CHECK(std::abs(other.slip_area_fraction - straight.certificate.slip->large_area_fraction) < kOfSteps);
  CHECK(std::abs(other.same_residue_area_fraction - straight.certificate.same_residue_area_fraction) < kOfSteps);
  CHECK(other.own_residue_area_fraction < share_of(result));
  CHECK(std::abs(other.own_residue_area_fraction - share_of(straight)) < kOfSteps);
}

TEST_CASE("a mapping is tried in long steps where atoms part from their surroundings, and domains do not part") {
  TwoAreas areas;
  Molecule source, target;
  espdiff::AtomPairing& pairing = areas.alignment.pairing;
  const espdiff::StatesToMap states{*areas.engine, areas.options, source,       areas.source,   areas.none,
                                    false,         target,        areas.target, areas.alignment};
  constexpr std::size_t kAtoms = 100, kOfResidue = 10;
  for (std::size_t i = 0; i < kAtoms; ++i) {
    const auto residue = static_cast<std::int32_t>(i / kOfResidue);
    if (i % kOfResidue == 0) source.residues.emplace_back();
    source.atoms.emplace_back();
    source.atoms.back().residue = residue;
    source.positions.push_back({static_cast<double>(3 * residue), 0.1 * static_cast<double>(i % kOfResidue), 0});
    pairing.pairs.emplace_back(i, i);
  }
  target.positions = source.positions;
  const espdiff::CommonFrame frame{};
  const auto move = [&](std::size_t begin, std::size_t end, double way_A) {
    for (std::size_t i = begin; i < end; ++i) target.positions[i].z = way_A;
  };
  CHECK_FALSE(espdiff::will_slip(states, frame));
  move(0, kAtoms, 30);
  CHECK_FALSE(espdiff::will_slip(states, frame));
  move(0, kAtoms / 2, 0);
  CHECK_FALSE(espdiff::will_slip(states, frame));
  move(0, kAtoms, 0);
  move(0, 1, 12);
  CHECK_FALSE(espdiff::will_slip(states, frame));
  move(1, 2, 9.2);
  CHECK_FALSE(espdiff::will_slip(states, frame));  // its surroundings go 0.4 A with it
  move(1, 2, 12);
  CHECK(espdiff::will_slip(states, frame));
}

TEST_CASE("the superposition that is kept after a trial in long steps has the bits of usual steps") {
  const auto a = real_input("series19_ubq_2k39/m14.pqr"), b = real_input("series19_ubq_2k39/m09.pqr");
  if (!a || !b) return;
  const Molecule source = espdiff::read_structure(*a, {}), target = espdiff::read_structure(*b, {});
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const auto compared = [&](const std::string& domains) {
    CompareOptions options;
    options.domains = domains;
    return compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
  };
  const CompareResult result = compared("as-needed"), straight = compared("none");
  CHECK(result.mapping.domains == "none");
  REQUIRE(result.mapping.other.has_value());
  CHECK(result.mapping.other->domains == "local");
  CHECK(hash_of(result) == hash_of(straight));
  CHECK(result.mapping.morph.steps == straight.mapping.morph.steps);
}

TEST_CASE("the round trip follows the mapping that is kept, and changes neither it nor its bits at one thread") {
  const Nucleocapsid pair;
  if (!pair.is_there) return;
  CompareOptions options = with("as-needed");
  options.round_trip = true;
  const CompareResult result = pair.compared(options, 1), again = pair.compared(with("as-needed"));
  CHECK(hash_of(result) == hash_of(again));
  REQUIRE(result.certificate.round_trip.has_value());
  CHECK(result.certificate.round_trip->mean_A < 1);
}

TEST_CASE("the second mapping reports its own stage, and can be cancelled there") {
  const Nucleocapsid pair;
  if (!pair.is_there) return;
  std::vector<std::string> stages;
  Progress* running = nullptr;
  Progress progress([&](const std::string& stage, double) {
    if (stages.empty() || stages.back() != stage) stages.push_back(stage);
    if (stage == "second morph") running->request_cancel();
  });
  running = &progress;
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareOptions options = with("as-needed");
  Series series(*engine, {&pair.source, nullptr}, options);
  CHECK_THROWS_AS(series.step({&pair.target, nullptr}, StartFrom::kSource, progress), espdiff::Cancelled);
  REQUIRE(stages.size() >= 3);
  CHECK(std::vector<std::string>(stages.end() - 3, stages.end()) ==
        std::vector<std::string>{"morph", "certificate", "second morph"});
  const CompareResult after = series.step({&pair.target, nullptr}, StartFrom::kSource, {});
  CHECK(hash_of(after) == hash_of(pair.compared(options)));
}

TEST_CASE("molecules that are refused by a warning are mapped once") {
  Nucleocapsid pair;
  if (!pair.is_there) return;
  for (float& radius : pair.target.radii) radius += 0.3F;
  const CompareResult result = pair.compared(with("as-needed"));
  REQUIRE_FALSE(result.certificate.trustworthy);
  CHECK(result.inputs.warnings[0].refuses);
  CHECK(result.certificate.slip->large_area_fraction > 0.08);
  CHECK(result.mapping.domains == "none");
  CHECK_FALSE(result.mapping.other.has_value());
}

TEST_CASE("a step that continues from the one before is mapped once") {
  const Nucleocapsid pair;
  if (!pair.is_there) return;
  Molecule next = pair.target;
  for (Vec3d& p : next.positions) p.z += 0.002 * p.x;
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  Series series(*engine, {&pair.source, nullptr}, with("as-needed"));
  const CompareResult first = series.step({&pair.target, nullptr}, StartFrom::kPrevious, {});
  CHECK(first.mapping.domains == "local");
  const CompareResult second = series.step({&next, nullptr}, StartFrom::kPrevious, {});
  CHECK(second.mapping.start == StartFrom::kPrevious);
  CHECK(second.mapping.domains == "none");
  CHECK_FALSE(second.mapping.other.has_value());
}

TEST_SUITE_END();
