// The region's numbers: of everything the whole's; of two complements the area-weighted mean.
#include <doctest/doctest.h>

#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"

using namespace espdiff;
using espdiff_test::make_side;

namespace {

CompareResult compared(const std::vector<std::uint8_t>& region) {
  static const espdiff_test::Side source = make_side(3, 0.0), target = make_side(4, 0.3);
  const auto engine = select_engine(DeviceChoice::kCpu, 2);
  CompareInput input = source.input();
  input.parts.region = region;
  return compare(*engine, input, target.input(), espdiff_test::quick_options(), Progress());
}

std::vector<std::uint8_t> residues(bool (*in)(std::size_t)) {
  const std::size_t n = make_side(3, 0.0).molecule.residues.size();
  std::vector<std::uint8_t> region;
  for (std::size_t r = 0; r < n; ++r) region.push_back(in(r) ? 1 : 0);
  return region;
}

}  // namespace

TEST_CASE("a region of all residues has the whole's numbers and verdict") {
  const CompareResult result = compared(residues([](std::size_t) { return true; }));
  REQUIRE(result.parts.size() == 1);
  const espdiff::PartResult& region = result.parts.front();
  CHECK(region.potential.metrics.area_A2 == result.potential.metrics.area_A2);
  CHECK(region.potential.metrics.mean_abs_difference == result.potential.metrics.mean_abs_difference);
  CHECK(region.potential.metrics.hodgkin_index == result.potential.metrics.hodgkin_index);
  CHECK(region.rmsd_A == doctest::Approx(result.rmsd_A).epsilon(1e-6));
  CHECK(region.certificate.unmatched_source == doctest::Approx(result.certificate.unmatched_source));
  CHECK(region.certificate.unmatched_target == doctest::Approx(result.certificate.unmatched_target));
  CHECK(region.certificate.mapped_to_target.mean == doctest::Approx(result.certificate.mapped_to_target.mean));
  CHECK(region.certificate.trustworthy == result.certificate.trustworthy);
  CHECK(region.residues.size() == result.residues.size());
}

TEST_CASE("two complementary regions share the area, and their means add up to the whole's") {
  const CompareResult first = compared(residues([](std::size_t r) { return r % 4 == 0; })),
                      second = compared(residues([](std::size_t r) { return r % 4 != 0; }));
  const Metrics &a = first.parts.at(0).potential.metrics, &b = second.parts.at(0).potential.metrics,
                &whole = first.potential.metrics;
  CHECK(first.potential.metrics.mean_abs_difference == second.potential.metrics.mean_abs_difference);
  CHECK(a.area_A2 + b.area_A2 == doctest::Approx(whole.area_A2).epsilon(1e-5));
  CHECK(a.area_A2 * a.mean_abs_difference + b.area_A2 * b.mean_abs_difference ==
        doctest::Approx(whole.area_A2 * whole.mean_abs_difference).epsilon(1e-5));
  CHECK(a.mean_abs_difference != doctest::Approx(b.mean_abs_difference));
  for (const ResidueRow& row : first.parts.at(0).residues) CHECK(row.residue % 4 == 0);
}

TEST_CASE("without a region there is none") { CHECK(compared({}).parts.empty()); }
