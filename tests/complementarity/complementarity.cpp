// complementarity.cpp: complementarity of made complexes, its parts, and what is refused.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "complementarity/complementarity_report.h"
#include "complementarity/weighted_correlation.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "options/options.h"
#include "potential/potential_plan.h"
#include "prepare/load_state.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Complementarity;
using espdiff::InterfaceOfComplex;
using espdiff::InterfaceSurface;
using espdiff::LoadedState;
using espdiff::Molecule;

namespace {

/// Two slabs of two layers of atoms each, chain A below chain B; the layers in contact have charges whose sign changes
/// with x, those of B times `sign`.
LoadedState two_slabs(double gap_A, double sign) {
  LoadedState state;
  Molecule& m = state.molecule;
  m.name = "slabs.pqr";
  m.radii_origin = espdiff::ValueOrigin::kFile;
  for (const bool is_second : {false, true}) {
    const double towards = is_second ? 1 : -1, contact = is_second ? gap_A : 0;
    for (int layer = 0; layer < 2; ++layer) {
      for (int i = 0; i < 5; ++i) {
        m.residues.push_back({"LIG", is_second ? "B" : "A", layer * 5 + i + 1, ' '});
        for (int j = 0; j < 4; ++j) {
          espdiff::Atom atom;
          atom.name = "C" + std::to_string(j);
          atom.element = "C";
          atom.residue = static_cast<std::int32_t>(m.residues.size()) - 1;
          m.atoms.push_back(atom);
          m.positions.push_back({3.0 * (i - 2), 3.0 * (j - 1.3), contact + towards * 3 * layer});
          m.radii.push_back(2.0F);
          const double charge = layer > 0 || i == 2 ? 0 : i < 2 ? 0.2 : -0.3;
          m.charges.push_back(static_cast<float>(is_second ? sign * charge : charge));
        }
      }
    }
  }
  return state;
}

espdiff::PotentialPlan plan_for(const LoadedState& state) {
  espdiff::PotentialRequest asked;
  asked.potential = "pb";
  asked.given = {{"pb-spacing", "1"}};
  return {asked, {facts_of(state)}, 300};
}

InterfaceOfComplex interface_of(espdiff::Engine& engine, const LoadedState& state,
                                const std::string& partners = "A:B") {
  return {engine,
          state,
          espdiff::parse_interface(partners),
          [plan = plan_for(state)](const LoadedState& charged) { return plan.map_of(charged); },
          {},
          {}};
}

std::string refused_interface(const std::string& partners) {
  return message_of([&] { atoms_of(espdiff::parse_interface(partners), two_slabs(4, -1).molecule); });
}

}  // namespace

TEST_SUITE_BEGIN("complementarity");

TEST_CASE("correlations with equal weights are the usual ones, and weights count as repetitions") {
  const std::vector<double> a = {1, 2, 3, 4, 5}, b = {2, 1, 4, 3, 7}, ones(5, 1.0);
  CHECK(espdiff::weighted_pearson(a, b, ones) == doctest::Approx(0.8241633836921342));
  CHECK(espdiff::weighted_spearman(a, b, ones) == doctest::Approx(0.8));
  CHECK(espdiff::weighted_pearson({1, 2, 3}, {2, 1, 4}, {2, 1, 1}) ==
        doctest::Approx(espdiff::weighted_pearson({1, 1, 2, 3}, {2, 2, 1, 4}, {1, 1, 1, 1})));
  CHECK(espdiff::weighted_spearman({1, 2, 3}, {2, 1, 4}, {2, 1, 1}) ==
        doctest::Approx(espdiff::weighted_spearman({1, 1, 2, 3}, {2, 2, 1, 4}, {1, 1, 1, 1})));
  CHECK(espdiff::weighted_spearman({1, 2, 3}, {1, 8, 27}, {1, 1, 1}) == doctest::Approx(1));
  CHECK(std::isnan(espdiff::weighted_pearson({1, 1}, {1, 2}, {1, 1})));
}

TEST_CASE("opposite charges are complementary, equal ones alike") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const InterfaceOfComplex opposite = interface_of(*engine, two_slabs(4, -1)),
                           alike = interface_of(*engine, two_slabs(4, 1));
  CHECK(opposite.result().pearson > 0.9);
  CHECK(opposite.result().spearman > 0.8);
  CHECK(alike.result().pearson == doctest::Approx(-opposite.result().pearson).epsilon(1e-3));
  for (const auto& side : opposite.result().sides) {
    CHECK(side.area_A2 > 50);
    CHECK(side.buried_area_A2 > side.area_A2);
    double sum = 0;
    for (const auto& residue : side.residues) sum += residue.contribution;
    CHECK(sum == doctest::Approx(side.pearson).epsilon(1e-5));
  }
  CHECK(opposite.result().sides[0].area_A2 == doctest::Approx(opposite.result().sides[1].area_A2).epsilon(0.03));
}

TEST_CASE("each potential is of one partner's charges alone, and moves with the complex") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const LoadedState state = two_slabs(4, -1);
  LoadedState moved = state, doubled = state;
  const auto motion = rigid({0, 0.6, 0.8}, 0.7, {11, -4, 6});
  for (auto& p : moved.molecule.positions) p = motion.apply(p);
  for (std::size_t i = state.molecule.size() / 2; i < state.molecule.size(); ++i) doubled.molecule.charges[i] *= 2;
  const InterfaceOfComplex here = interface_of(*engine, state), there = interface_of(*engine, moved);
  CHECK(there.result().pearson == doctest::Approx(here.result().pearson).epsilon(1e-3));
  const InterfaceSurface& once = here.result().sides[0].surface;
  const InterfaceOfComplex stronger = interface_of(*engine, doubled);
  const InterfaceSurface& twice = stronger.result().sides[0].surface;
  REQUIRE(once.own.size() == twice.own.size());
  for (std::size_t v = 0; v < once.own.size(); ++v) {
    REQUIRE(twice.own[v] == once.own[v]);
    REQUIRE(twice.other[v] == doctest::Approx(2 * once.other[v]).epsilon(1e-3));
  }
  CHECK(stronger.result().pearson == doctest::Approx(here.result().pearson).epsilon(1e-4));
}

TEST_CASE("a complex does not differ from itself, and another charge has its residue named") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const LoadedState state = two_slabs(4, -1);
  LoadedState mutant = state;
  for (std::size_t i = 4; i < 8; ++i) mutant.molecule.charges[i] = -0.2F;  // residue A 2
  espdiff::ComplementarityResult result;
  result.request = espdiff::parse_interface("A:B");
  const InterfaceOfComplex from = interface_of(*engine, state), to = interface_of(*engine, mutant);
  const auto compared_with = [&](const InterfaceOfComplex& other) {
    result.states = {&from.result(), &other.result()};
    result.changes.clear();
    for (std::size_t side = 0; side < 2; ++side)
      result.changes.push_back(change_of_side(*engine, from, other, side, {}, {}));
    return interface_rows(result);
  };
  for (const auto& row : compared_with(from)) CHECK(row.change() == 0);
  for (const auto& change : result.changes) {
    for (std::size_t v = 0; v < change.source.local.size(); v += 7) {
      if (std::isfinite(change.source.local[v]) && std::isfinite(change.target.local[v]))
        CHECK(change.target.local[v] == doctest::Approx(change.source.local[v]).epsilon(0.05));
    }
  }
  double largest = 0;
  std::string who;
  for (const auto& row : compared_with(to)) {
    if (row.side != 0 || std::fabs(row.change()) <= largest) continue;
    largest = std::fabs(row.change());
    who = row.residue.chain + std::to_string(row.residue.number);
  }
  CHECK(who == "A2");
  CHECK(to.result().pearson < from.result().pearson - 0.1);
}

TEST_CASE("partners that do not touch, overlap or are not there are refused") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  CHECK(message_of([&] { interface_of(*engine, two_slabs(20, -1)); }) ==
        "interface A:B: in slabs.pqr the partners bury no surface in each other (nearest atoms 20.0 A apart); name "
        "partners that touch");
  CHECK(
      refused_interface("A") ==
      "interface: 'A' does not name two partners; write chains, such as H,L:A, or two selections with a colon between "
      "them");
  CHECK(refused_interface("A:C").rfind("interface: 'C' selects no atom; slabs.pqr has chain A", 0) == 0);
  CHECK(refused_interface("A:A,B") ==
        "interface: LIG 1 of chain A belongs to both partners; name two that share no atom");
}

TEST_SUITE_END();
