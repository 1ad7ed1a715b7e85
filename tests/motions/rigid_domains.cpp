// rigid_domains.cpp: molecules whose domains move far are compared domain by domain, by both methods.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "base/molecule/screw.h"
#include "compare/built_molecule.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "options/options.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/records/metrics.h"
#include "report/sections/provenance.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::compare;
using espdiff::Method;

namespace {

/// A dumbbell: two lopsided balls, chains A and B, joined by a thin bridge of chain A.
Molecule dumbbell() {
  Builder b;
  b.add_ball(1, {0, 0, 0}, 7, 2.0, "A");
  b.add_ball(2, {4, 5, 0}, 4, 2.0, "A");
  for (int i = 0; i < 4; ++i) b.add("BRG", 3, "C" + std::to_string(i), {8.0 + 2 * i, 0, 0.4 * (i % 2)}, 1.7F, "A");
  b.add_ball(1, {22, 0, 0}, 7, 2.0, "B");
  b.add_ball(2, {24, 3, 5}, 4, 2.0, "B");
  b.molecule.charges.assign(b.molecule.size(), 0.0F);
  return b.molecule;
}

/// Chain B rotated about the middle of the bridge.
Molecule swung(const Molecule& m, double angle) {
  espdiff::Screw screw;
  screw.axis = {0, 0.6, 0.8};
  screw.through = {11, 0, 0};
  screw.angle = angle;
  Molecule result = m;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m.residues[static_cast<std::size_t>(m.atoms[i].residue)].chain == "B")
      result.positions[i] = screw.apply(m.positions[i], 1);
  }
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("rigid_domains");

TEST_CASE("a domain that swings as a rigid body has no displacement, by both methods") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const Molecule source = dumbbell(), target = swung(source, 1.0);
  for (const Method method : {Method::kMorph, Method::kDeform}) {
    CompareOptions options;
    options.method = method;
    const auto displacement_with = [&](const char* domains) {
      options.domains = domains;
      const CompareResult r = compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
      CHECK(r.certificate.converged);
      if (method == Method::kMorph) CHECK(r.certificate.self_intersecting_pairs == 0);
      return std::pair(espdiff::counted_metrics(r).mean_displacement_A, r);
    };
    const auto [as_a_whole, whole] = displacement_with("none");
    const auto [by_domains, chains] = displacement_with("chains");
    CAPTURE(to_string(method));
    CHECK(by_domains < 0.1);
    CHECK(as_a_whole > 8 * by_domains);  // deform lets a ball turn under its surface, so that it moves little
    CHECK(whole.alignment.domains.empty());
    REQUIRE(chains.alignment.domains.size() == 2);
    CHECK(chains.alignment.domains[1].rmsd_A < 1e-9);
    CHECK(chains.certificate.same_residue_area_fraction > 0.95);
  }
}

TEST_CASE("the round trip uses the domains' motions and their inverses") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const Molecule source = dumbbell(), target = swung(source, 1.2);
  CompareOptions options;
  options.domains = "chains";
  options.round_trip = true;
  const CompareResult r = compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
  REQUIRE(r.certificate.round_trip.has_value());
  CHECK(r.certificate.round_trip->mean_A < 0.1);
  CHECK(r.certificate.trustworthy);
}

TEST_CASE("one domain of the whole molecule changes only rounding") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  CompareOptions options = quick_options();
  const CompareResult whole = compare(*engine, a.input(), b.input(), options, {});
  options.domains = "chains";
  const CompareResult domain = compare(*engine, a.input(), b.input(), options, {});
  REQUIRE(domain.alignment.domains.size() == 1);
  CHECK(domain.alignment.domains[0].rmsd_A == doctest::Approx(whole.rmsd_A));
  CHECK(domain.potential.metrics.mean_abs_difference ==
        doctest::Approx(whole.potential.metrics.mean_abs_difference).epsilon(1e-3));
  CHECK(domain.potential.metrics.mean_displacement_A ==
        doctest::Approx(whole.potential.metrics.mean_displacement_A).epsilon(1e-3));
}

TEST_CASE("a result names its domains") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const Molecule source = dumbbell(), target = swung(source, 0.5);
  CompareOptions options;
  options.domains = "A:1-3/B:1-2";
  const CompareResult r = compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
  const auto json = espdiff::compare_json(source, target, r, options, {});
  const auto& domains = json["superposition"]["domains"];
  REQUIRE(domains.size() == 2);
  CHECK(domains[1]["residues"] == "B:1-2");
  CHECK(domains[1]["n_residues"] == 2);
  CHECK(domains[1]["rmsd_A"].get<double>() < 1e-9);
  CHECK(json["options"]["domains"] == "A:1-3/B:1-2");
  std::ostringstream table;
  espdiff::print_table(table, json);
  CHECK(table.str().find("Rigid domain") != std::string::npos);
  CHECK(table.str().find("A, B:1-2\n") != std::string::npos);
}

TEST_CASE("domains of molecules without pairs are refused") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const Molecule source = dumbbell();
  Molecule other;
  for (std::size_t i = 0; i < 200; ++i) {
    other.positions.push_back(
        {static_cast<double>(i % 6), static_cast<double>(i / 6 % 6), static_cast<double>(i / 36)});
    other.radii.push_back(1.7F);
    other.atoms.push_back({"X" + std::to_string(i), "C", 0, true});
  }
  other.residues.push_back({"LIG", "L", 1, ' '});
  CompareOptions options;
  options.method = Method::kDeform;
  options.align = espdiff::AlignAtoms::kNone;
  options.domains = "chains";
  CHECK(message_of([&] {
          compare(*engine, {&source, nullptr}, {&other, nullptr}, options, {});
        }) == "domains need paired atoms, and none pair; give domains none");
}

TEST_SUITE_END();
