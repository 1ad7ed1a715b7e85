// round_trip.cpp: the round-trip error of both methods, and what the option changes.
#include <doctest/doctest.h>

#include <algorithm>

#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::compare;

TEST_SUITE_BEGIN("round_trip");

TEST_CASE("the round-trip error is small, smaller with the morph") {
  const Side a = make_side(1, 0), b = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CompareOptions options = quick_options();
  options.round_trip = true;
  const CompareResult morphed = compare(*engine, a.shape(), b.shape(), options, {});
  REQUIRE(morphed.certificate.round_trip.has_value());
  CHECK(morphed.certificate.round_trip->mean_A < 0.1);
  CHECK(morphed.certificate.round_trip->mean_A <= morphed.certificate.round_trip->p95_A);
  CHECK(morphed.certificate.round_trip->p95_A <= morphed.certificate.round_trip->max_A);
  CHECK(morphed.certificate.not_checked.empty());
  options.method = espdiff::Method::kDeform;
  options.deform.max_iterations = 3000;
  const CompareResult deformed = compare(*engine, a.shape(), b.shape(), options, {});
  REQUIRE(deformed.certificate.round_trip.has_value());
  CHECK(morphed.certificate.round_trip->mean_A < deformed.certificate.round_trip->mean_A);
}

TEST_CASE("a protein in two conformations, 3.8 A apart, has a round-trip error within the limit") {
  const auto from = real_input("series19_ubq_2k39/m13.pqr"), to = real_input("series19_ubq_2k39/m02.pqr");
  if (!from || !to) return;
  const Molecule a = espdiff::read_structure(*from), b = espdiff::read_structure(*to);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CompareOptions options;
  options.domains = "none";  // local motions slip less here, but their way back is farther from it: 0.115 A
  options.round_trip = true;
  const CompareResult result = compare(*engine, {&a, nullptr}, {&b, nullptr}, options, {});
  REQUIRE(result.certificate.round_trip.has_value());
  CHECK(result.certificate.round_trip->mean_A < 0.09);
  CHECK(result.certificate.unmatched_source < 0.025);
  CHECK(result.certificate.same_residue_area_fraction > 0.75);
  // The tail slips, which the round trip does not see.
  CHECK(result.certificate.trusted.by_why[static_cast<std::size_t>(espdiff::Why::kSlipped)] > 0.05);
  CHECK(result.certificate.trusted.share() < espdiff::kWholeShare);
}

TEST_CASE("the round trip changes no other result, and is listed as not checked without the option") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CompareOptions options = quick_options();
  const CompareResult once = compare(*engine, a.input(), b.input(), options, {});
  CHECK_FALSE(once.certificate.round_trip.has_value());
  const std::vector<std::string>& not_checked = once.certificate.not_checked;
  CHECK(std::count(not_checked.begin(), not_checked.end(), "round_trip") == 1);
  options.round_trip = true;
  const CompareResult twice = compare(*engine, a.input(), b.input(), options, {});
  CHECK(hash_of(once) == hash_of(twice));
}

TEST_SUITE_END();
