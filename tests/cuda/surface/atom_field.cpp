// atom_field.cpp: values of atoms carried to a surface, against sums over all atoms in double precision.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/field_stage.h"

using namespace espdiff_test;
using espdiff::AtomValues;
using espdiff::AtomWeight;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

AtomValues with_values(const AtomSet& atoms, AtomWeight weight) {
  AtomValues values{atoms.positions, atoms.widths, {}, weight};
  for (std::size_t i = 0; i < atoms.size(); ++i)
    values.values.push_back(i % 7 == 3 ? kNone : static_cast<float>(std::sin(static_cast<double>(i))));
  return values;
}

/// The definition, over all atoms.
double searched(const AtomValues& atoms, const Vec3d& p) {
  double known = 0, sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < atoms.positions.size(); ++i) {
    if (!std::isfinite(atoms.values[i])) continue;
    const double d = norm(p - atoms.positions[i]), s = static_cast<double>(atoms.widths[i]),
                 v = static_cast<double>(atoms.values[i]);
    if (atoms.weight == AtomWeight::kDecaySum) {
      if (d >= espdiff::kDecayReach_A) continue;
      sum += v * std::exp(-d);
      ++n;
    } else {
      const double g = std::exp(-d * d / (2 * s * s));
      known += g;
      sum += g * v;
    }
  }
  if (atoms.weight == AtomWeight::kDecaySum) return n > 0 ? sum : std::nan("");
  return sum / known;
}

}  // namespace

TEST_SUITE_BEGIN("atom field");

TEST_CASE("means and sums are those over all atoms") {
  const AtomSet atoms = random_cloud(300, 110);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto surface = engine->isosurface(engine->density(uploaded, 1.0), 0.5F);
    const auto points = engine->download_positions(surface);
    for (const AtomWeight weight : {AtomWeight::kDensityMean, AtomWeight::kDecaySum}) {
      const AtomValues values = with_values(atoms, weight);
      const std::vector<float> read = engine->atom_field(surface, values);
      REQUIRE(read.size() == points.size());
      double worst = 0;
      std::size_t n = 0;
      for (std::size_t v = 0; v < read.size(); ++v) {
        const double exact = searched(values, static_cast<Vec3d>(points[v]));
        if (!std::isfinite(read[v]) || !std::isfinite(exact)) continue;
        ++n;
        worst = std::max(worst, std::fabs(static_cast<double>(read[v]) - exact));
      }
      // Gaussians end at 4.5 widths; an atom at the border of the reach of 5 A counts or not, e^-5.
      CHECK(worst < 0.01);
      CHECK(10 * n > 9 * read.size());
    }
  }
}

TEST_CASE("equal values give exactly that value") {
  AtomValues atoms{random_cloud(200, 111).positions, random_cloud(200, 111).widths, std::vector<float>(200, 0.3F)};
  for (const auto& engine : back_ends()) {
    const auto surface = engine->isosurface(engine->density(upload(*engine, random_cloud(200, 111)), 1.0), 0.5F);
    const std::vector<float> read = engine->atom_field(surface, atoms);
    CHECK(read == std::vector<float>(read.size(), 0.3F));
  }
}

TEST_CASE("where most of the density has no value, and where no atom reaches, there is none") {
  for (const auto& engine : back_ends()) {
    const AtomValues two{{{0, 0, 0}, {4, 0, 0}}, {1.5F, 1.5F}, {kNone, 2.0F}};
    const auto at = [&](double x) {
      Mesh sphere = icosphere(0, 0.01);
      for (auto& p : sphere.positions) p = p + Vec3f{static_cast<float>(x), 0, 0};
      return engine->atom_field(engine->upload_mesh(sphere), two).front();
    };
    CHECK(std::isnan(at(1)));
    CHECK(at(3) == 2.0F);
    CHECK(std::isnan(at(30)));
  }
}

TEST_CASE("no value at all, and another number of values than of atoms, are refused") {
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(icosphere(1, 2));
    CHECK_THROWS_WITH_AS(engine->atom_field(mesh, {{{0, 0, 0}}, {1.5F}, {kNone}}), "atom_field: no atom has a value",
                         espdiff::InputError);
    CHECK_THROWS_WITH_AS(engine->atom_field(mesh, {{{0, 0, 0}}, {1.5F}, {}}),
                         "atom_field: needs one width and one value per atom", espdiff::InputError);
  }
}

TEST_SUITE_END();
