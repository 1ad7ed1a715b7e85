// shape_fields.cpp: fields of the shape and of the potential, and patches, through a whole comparison.
#include <doctest/doctest.h>

#include <algorithm>
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
using espdiff::FieldResult;

namespace {

CompareOptions with_kinds(std::vector<espdiff::FieldRequest> fields,
                          std::vector<espdiff::PatchesRequest> patches = {}) {
  CompareOptions options = quick_options();
  options.fields = std::move(fields);
  options.patches_of = std::move(patches);
  return options;
}

/// A side of another orientation.
Side turned_side(const Side& side) {
  Side moved = side;
  const auto motion = rigid({0, 0.6, 0.8}, 0.7, {11, -4, 6});
  for (auto& p : moved.molecule.positions) p = motion.apply(p);
  return moved;
}

}  // namespace

TEST_SUITE_BEGIN("shape fields");

TEST_CASE("curvature and distances do not change with a rigid motion") {
  const Side source = make_side(1, 0), moved = turned_side(source);
  for (const auto& engine : back_ends()) {
    const CompareResult r =
        compare(*engine, source.shape(), moved.shape(),
                with_kinds({{"curvature", "curvature"}, {"site", "distance://A/3"}}, {{"site", {}, 8.0}}), {});
    REQUIRE(r.fields.size() == 2);
    const FieldResult &curvature = r.fields[0], &site = r.fields[1];
    CHECK(curvature.metrics.area_A2 > 100);
    CHECK(curvature.metrics.correlation > 0.999);
    CHECK(site.metrics.mean_abs_difference < 1e-4);
    // The definition, at the vertices.
    for (std::size_t v = 0; v < site.source.size(); v += 17) {
      double nearest = 1e9;
      for (std::size_t i = 0; i < source.molecule.size(); ++i) {
        if (source.molecule.atoms[i].residue == 2)
          nearest = std::min(nearest, norm(r.surface.source_positions[v] - source.molecule.positions[i]));
      }
      REQUIRE(static_cast<double>(site.source[v]) == doctest::Approx(nearest).epsilon(1e-4));
    }
    // What is near the site is one patch in both states.
    REQUIRE(r.field_patches.size() == 1);
    REQUIRE(r.field_patches[0].source.size() == 1);
    CHECK(r.field_patches[0].source[0].fate == espdiff::PatchFate::kUnchanged);
    const auto& residues = r.field_patches[0].source[0].residues;
    CHECK(std::any_of(residues.begin(), residues.end(), [](const auto& residue) { return residue.first == 2; }));
    CHECK(r.field_patches[0].target[0].area_A2 == doctest::Approx(r.field_patches[0].source[0].area_A2).epsilon(0.01));
  }
}

TEST_CASE("the electric field is the slope of the potential along the normal, and at least as large") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const CompareOptions options = with_kinds({{"normal-field", "normal-field"}, {"field-strength", "field-strength"}});
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, source.input(), target.input(), options, {});
    const FieldResult &normal = r.fields.at(0), &strength = r.fields.at(1);
    CHECK(normal.quantity.unit == "kT/e/A");
    double squares = 0, errors = 0;
    for (std::size_t v = 0; v < normal.source.size(); ++v) {
      const Vec3d n = static_cast<Vec3d>(r.surface.source_normals[v]), p = r.surface.source_positions[v];
      // The derivative of sum q / sqrt(d^2 + 4), which the map holds.
      double slope = 0;
      for (std::size_t i = 0; i < source.molecule.size(); ++i) {
        const Vec3d d = p - source.molecule.positions[i];
        slope -= static_cast<double>(source.molecule.charges[i]) * dot(d, n) / std::pow(dot(d, d) + 4, 1.5);
      }
      const double error = static_cast<double>(normal.source[v]) + slope;
      errors += error * error;
      squares += slope * slope;
      REQUIRE(strength.source[v] >= std::fabs(normal.source[v]) - 1e-6F);
    }
    CHECK(std::sqrt(errors / squares) < 0.06);  // of a lattice of 1 A
    CHECK(normal.metrics.area_A2 > 100);
  }
}

TEST_CASE("fields and patches of the potential are refused without one, and a selection of nothing too") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const auto refused = [&](const CompareOptions& options) {
    return message_of([&] { compare(*engine, source.shape(), target.shape(), options, {}); });
  };
  CHECK(refused(with_kinds({{"normal-field", "normal-field"}})) ==
        "field normal-field: 'Normal electric field' is read from the potential, which these states lack; give charges "
        "or maps, or leave the field out");
  CHECK(refused(with_kinds({}, {{"potential", 1.0, {}}})) ==
        "patches-of potential>1: these states have no potential; give charges or maps, or another field");
  CHECK(refused(with_kinds({{"d", "distance://Z"}}))
            .rfind("field d: molecule.pqr: field '//Z' selects no atom; the file has ", 0) == 0);
}

TEST_CASE("a threshold without any area is a warning with what there is") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  const CompareResult r =
      compare(*engine, source.input(), target.input(), with_kinds({}, {{"potential", 900.0, {}}}), {});
  REQUIRE(!r.inputs.warnings.empty());
  const std::string text = r.inputs.warnings.back().text.plain();
  CHECK(text.rfind("patches of potential>900: neither state has a connected area of 10 A^2 there; the values go from ",
                   0) == 0);
  CHECK(text.find(" kT/e: take another threshold") != std::string::npos);
}

TEST_CASE("patches have the same bits for 1, 2 and 4 threads") {
  const Side source = make_side(1, 0), target = make_side(1, 0.3);
  std::vector<std::uint64_t> hashes;
  for (const int n_threads : {1, 2, 4}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
    const CompareResult r = compare(*engine, source.input(), target.input(),
                                    with_kinds({{"curvature", "curvature"}, {"normal-field", "normal-field"}},
                                               {{"potential", 0.05, -0.05}, {"curvature", {}, 0.0}}),
                                    {});
    Hash hash;
    for (const FieldResult& f : r.fields) hash.add(f.source).add(f.target);
    for (const auto& patches : r.field_patches) {
      CHECK(!patches.source.empty());
      hash.add(patches.source_patch).add(patches.target_patch);
      for (const auto& patch : patches.source) hash.add(patch.area_A2).add(patch.mean);
    }
    hashes.push_back(hash.value());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

TEST_SUITE_END();
