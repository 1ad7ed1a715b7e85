// offset.cpp: potentials read outside the surfaces: where, what is left out, and the metrics by distance.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "cuda/surface/back_ends.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "options/settings.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

/// The potential that made_side's map holds, between its points.
double exact_at(const Molecule& molecule, const Vec3d& at) {
  double sum = 0;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    const Vec3d d = at - molecule.positions[i];
    sum += static_cast<double>(molecule.charges[i]) / std::sqrt(dot(d, d) + 4);
  }
  return sum;
}

CompareOptions read_at(std::vector<double> offsets_A) {
  CompareOptions options = quick_options();
  options.offsets_A = std::move(offsets_A);
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("offset");

TEST_CASE("both potentials are read outside, each along its own surface's normal") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, source.input(), target.input(), read_at({1.4}), {});
    const auto& s = r.surface;
    double worst_source = 0, worst_target = 0, largest = 0;
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
      const Vec3d from = s.source_positions[v] + 1.4 * static_cast<Vec3d>(s.source_normals[v]),
                  to = s.positions[v] + 1.4 * static_cast<Vec3d>(s.normals[v]);
      if (std::isfinite(s.potential_source[v])) {
        const double exact = exact_at(source.molecule, from);
        largest = std::max(largest, std::fabs(exact));
        worst_source = std::max(worst_source, std::fabs(static_cast<double>(s.potential_source[v]) - exact));
      }
      if (std::isfinite(s.potential_target[v]))
        worst_target = std::max(worst_target,
                                std::fabs(static_cast<double>(s.potential_target[v]) - exact_at(target.molecule, to)));
    }
    // Linear interpolation on 1 A is what is left.
    CHECK(worst_source < 0.02 * largest);
    CHECK(worst_target < 0.02 * largest);
  }
}

TEST_CASE("points inside the surface again are counted and left out, and the mapping does not change") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareResult on = compare(*engine, source.input(), target.input(), quick_options(), {}),
                      out = compare(*engine, source.input(), target.input(), read_at({2.5}), {});
  REQUIRE(out.potential.by_offset.size() == 1);
  const espdiff::OffsetMetrics& at = out.potential.by_offset.front();
  std::size_t n_missing = 0;
  for (const float v : out.surface.potential_source) n_missing += std::isfinite(v) ? 0 : 1;
  CHECK(at.n_inside_source + at.n_outside_source_map == n_missing);
  CHECK(out.potential.metrics.area_A2 <= on.potential.metrics.area_A2);
  CHECK(out.certificate.mapped_to_target.mean == on.certificate.mapped_to_target.mean);
  CHECK(out.certificate.trustworthy == on.certificate.trustworthy);
  CHECK(out.potential.metrics.mean_abs_difference != on.potential.metrics.mean_abs_difference);
}

TEST_CASE("a list gives the metrics of each distance; the first one is the result's own") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareResult all = compare(*engine, source.input(), target.input(), read_at({1.4, 0, 3}), {});
  REQUIRE(all.potential.by_offset.size() == 3);
  CHECK(all.potential.metrics.mean_abs_difference == all.potential.by_offset[0].metrics.mean_abs_difference);
  for (const auto& at : all.potential.by_offset) {
    const CompareResult alone = compare(*engine, source.input(), target.input(), read_at({at.offset_A}), {});
    CHECK(at.metrics.mean_abs_difference == alone.potential.metrics.mean_abs_difference);
    CHECK(at.metrics.hodgkin_index == alone.potential.metrics.hodgkin_index);
  }
  const CompareResult plain = compare(*engine, source.input(), target.input(), quick_options(), {});
  CHECK(all.potential.by_offset[1].metrics.mean_abs_difference == plain.potential.metrics.mean_abs_difference);
}

TEST_CASE("a distance beyond the map is refused") {
  const Side source = make_side(1, 0);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CHECK(message_of([&] {
          compare(*engine, source.input(), source.input(), read_at({20}), {});
        }).find("no vertex of the surface lies in it") != std::string::npos);
}

TEST_CASE("what is no list of distances is refused") {
  const auto refused = [](const std::string& text) {
    return message_of([&] { espdiff::make_options({{"offset", text}}); });
  };
  const std::string accepted = "a distance of 0 to 20 Angstrom, or a list of some such as 0,1.4,3";
  for (const char* const text : {"-1", "21", "1.4 A", "", "1,", "nan"})
    CHECK(refused(text) == "offset: '" + std::string(text) + "' is not " + accepted);
  CHECK(refused("1,1") == "offset: '1,1' is not " + accepted + ", each once");
  CHECK(espdiff::find_setting("offset").get(espdiff::make_options({{"offset", "0,1.4,3"}})) == "0,1.4,3");
}

TEST_SUITE_END();
