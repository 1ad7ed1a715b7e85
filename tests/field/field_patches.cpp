// field_patches.cpp: connected areas of planted fields on a sphere, and what becomes of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "cuda/surface/shapes.h"
#include "field/field_patches.h"
#include "field/patches_request.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::FieldPatch;
using espdiff::FieldPatches;
using espdiff::PatchesRequest;
using espdiff::PatchFate;

namespace {

constexpr double kRadius = 20;

/// A sphere with caps about axes: the field is 1 - angle / opening within an opening angle of a pole, the largest of
/// all poles.
struct Cap {
  Vec3d pole;
  double opening;
};

class Sphere {
 public:
  Sphere() : mesh_(icosphere(5, kRadius)) {
    for (const Vec3f& p : mesh_.positions) positions_.push_back(static_cast<Vec3d>(p));
    residue_.assign(positions_.size(), 0);
    for (std::size_t v = 0; v < positions_.size(); ++v) residue_[v] = positions_[v].x > 0 ? 1 : 0;
    why_.assign(mesh_.triangles.size(), 0);
  }

  /// cos(angle to the nearest pole) - cos(opening): positive within the caps.
  std::vector<float> field(const std::vector<Cap>& caps) const {
    std::vector<float> values;
    for (const Vec3d& p : positions_) {
      double largest = -2;
      for (const Cap& cap : caps)
        largest = std::max(largest, dot(p, cap.pole) / (kRadius * norm(cap.pole)) - std::cos(cap.opening));
      values.push_back(static_cast<float>(largest));
    }
    return values;
  }

  FieldPatches patches(const PatchesRequest& request, const std::vector<float>& source,
                       const std::vector<float>& target) const {
    return espdiff::find_field_patches({"q", "Q", "", true}, request, mesh_.triangles,
                                       {positions_, source, residue_, {}}, {positions_, target, residue_, {}}, why_);
  }
  void distrust(const std::function<bool(const Vec3d&)>& there) {
    for (std::size_t t = 0; t < why_.size(); ++t) why_[t] = there(positions_[mesh_.triangles[t][0]]) ? 4 : 0;
  }
  std::size_t n_vertices() const { return positions_.size(); }

 private:
  Mesh mesh_;
  std::vector<Vec3d> positions_;
  std::vector<std::int32_t> residue_;
  std::vector<std::uint8_t> why_;
};

double cap_area(double opening) { return 2 * kPi * kRadius * kRadius * (1 - std::cos(opening)); }

const PatchesRequest kAboveZero{"q", 0.0, {}};
const Vec3d kX{1, 0, 0}, kY{0, 1, 0}, kNearX{std::cos(0.8), std::sin(0.8), 0};

std::string refused_patches(const std::string& text) {
  return message_of([&] { espdiff::check_patches_of(espdiff::parse_patches_of(text), {}); });
}

}  // namespace

TEST_SUITE_BEGIN("field patches");

TEST_CASE("a cap has its area, mean, largest value and residues, on both sides of zero") {
  const Sphere sphere;
  const std::vector<float> field = sphere.field({{kX, 0.5}});
  const FieldPatches found = sphere.patches({"q", 0.0, -1.8}, field, field);
  REQUIRE(found.source.size() == 2);
  const FieldPatch& cap = found.source[0];
  CHECK(cap.is_above);
  CHECK(cap.area_A2 == doctest::Approx(cap_area(0.5)).epsilon(0.005));
  CHECK(cap.extreme == doctest::Approx(1 - std::cos(0.5)).epsilon(1e-3));
  CHECK(cap.mean == doctest::Approx((1 - std::cos(0.5)) / 2).epsilon(0.01));  // linear in the height
  REQUIRE(cap.residues.size() == 1);
  CHECK(cap.residues[0].first == 1);
  CHECK(cap.residues[0].second == doctest::Approx(cap.area_A2));
  // Below -1.8: cos < -1.8 + cos(0.5), a cap about the other pole.
  const double opening = kPi - std::acos(-1.8 + std::cos(0.5));
  CHECK(!found.source[1].is_above);
  CHECK(found.source[1].area_A2 == doctest::Approx(cap_area(opening)).epsilon(0.01));
  CHECK(found.source[1].residues[0].first == 0);
  for (const FieldPatch& patch : found.source) CHECK(patch.fate == PatchFate::kUnchanged);
  CHECK(std::count(found.source_patch.begin(), found.source_patch.end(), 1) > 100);
}

TEST_CASE("planted caps grow, shrink, vanish, appear, merge and split") {
  const Sphere sphere;
  const auto fate = [&](const std::vector<Cap>& source, const std::vector<Cap>& target) {
    const FieldPatches found = sphere.patches(kAboveZero, sphere.field(source), sphere.field(target));
    std::string text;
    for (const auto* const patches : {&found.source, &found.target}) {
      for (const FieldPatch& patch : *patches) text += std::string(text.empty() ? "" : " ") + to_string(patch.fate);
      text += " |";
    }
    return text;
  };
  CHECK(fate({{kX, 0.4}}, {{kX, 0.4}}) == "unchanged | unchanged |");
  CHECK(fate({{kX, 0.4}}, {{kX, 0.5}}) == "grew | grew |");
  CHECK(fate({{kX, 0.5}}, {{kX, 0.4}}) == "shrank | shrank |");
  CHECK(fate({{kX, 0.4}}, {{kY, 0.3}}) == "vanished | appeared |");
  CHECK(fate({{kX, 0.35}, {kNearX, 0.3}}, {{kX, 0.5}, {kNearX, 0.5}}) == "merged merged | merged |");
  CHECK(fate({{kX, 0.5}, {kNearX, 0.5}}, {{kX, 0.35}, {kNearX, 0.3}}) == "split | split split |");
}

TEST_CASE("what is not trusted is unknown, and small areas are counted") {
  Sphere sphere;
  const std::vector<float> cap = sphere.field({{kX, 0.4}}), none = sphere.field({{kX, 0.0}});
  sphere.distrust([](const Vec3d& p) { return p.x > 0; });
  CHECK(sphere.patches(kAboveZero, cap, none).source.at(0).fate == PatchFate::kUnknown);
  CHECK(sphere.patches(kAboveZero, cap, none).source.at(0).trusted_area_A2 == 0);
  const FieldPatches small = sphere.patches(kAboveZero, sphere.field({{kX, 0.08}}), none);
  CHECK(small.source.empty());
  CHECK(small.n_small_source == 1);
  std::vector<float> holes = cap;
  for (std::size_t v = 0; v < holes.size(); v += 2) holes[v] = std::nanf("");
  for (const FieldPatch& patch : sphere.patches(kAboveZero, cap, holes).target) CHECK(std::isfinite(patch.area_A2));
}

TEST_CASE("requests are read, written and refused in words") {
  const auto requests = espdiff::parse_patches_of("potential,h>1.5,q<-2>3");
  REQUIRE(requests.size() == 3);
  CHECK(to_string(requests[0]) == "potential>1<-1");
  CHECK(to_string(requests[1]) == "h>1.5");
  CHECK(to_string(requests[2]) == "q>3<-2");
  const std::string form = "; write FIELD>T for what lies above T, FIELD<T for what lies below, or FIELD>T<U";
  CHECK(refused_patches("charge") == "patches-of: 'charge' has no threshold" + form);
  CHECK(refused_patches("charge>a") == "patches-of: 'charge>a' has no number behind >" + form);
  CHECK(refused_patches("charge>1>2") == "patches-of: 'charge>1>2' has two thresholds behind >" + form);
  CHECK(refused_patches("charge>-1<1") == "patches-of: 'charge>-1<1' has thresholds that overlap" + form);
  CHECK(refused_patches(">1") == "patches-of: '>1' names no field" + form);
  CHECK(refused_patches("charge>1") ==
        "patches-of charge>1: the field 'charge' is not compared; give field charge as well");
  CHECK_NOTHROW(espdiff::check_patches_of(espdiff::parse_patches_of("charge>1"), {{"charge", "charge"}}));
  CHECK(refused_patches("potential>1,potential<-1") ==
        "patches-of: the field 'potential' is there twice; give both thresholds at once, as in potential>1<-1");
}

TEST_SUITE_END();
