// certificate.cpp: the fit of a mapped mesh to its target: corrupt and flipped area, irregularity.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/read_atoms.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::FitReport;

namespace {

constexpr double kWidth = 2.0;
const double kRadius = kWidth * std::sqrt(2 * std::log(2.0));  // of the isosurface at 0.5

FitReport fit(Engine& engine, const Mesh& mesh) {
  return engine.fit(engine.upload_mesh(mesh), upload(engine, one_gaussian({0, 0, 0}, kWidth)), 0.5F);
}

double sum(const std::vector<float>& values) {
  double total = 0;
  for (const float value : values) total += static_cast<double>(value);
  return total;
}

}  // namespace

TEST_SUITE_BEGIN("certificate");

TEST_CASE("a sphere on its isosurface fits; inside out it is flipped all over, and corrupt nowhere") {
  const Mesh sphere = icosphere(3, kRadius);
  for (const auto& engine : back_ends()) {
    const FitReport good = fit(*engine, sphere);
    CHECK(good.corrupt_area_fraction == 0);
    CHECK(good.flipped_area_fraction == 0);
    CHECK(good.area_A2 == doctest::Approx(area_oracle(sphere)).epsilon(1e-6));
    CHECK(sum(engine->download(good.corrupt)) == 0);
    const FitReport bad = fit(*engine, turned(sphere));
    CHECK(bad.corrupt_area_fraction == 0);
    CHECK(bad.flipped_area_fraction == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("the corrupt band is a density within 0.1 of the isovalue") {
  const auto radius_at = [](double density) { return kWidth * std::sqrt(-2 * std::log(density)); };
  for (const auto& engine : back_ends()) {
    // The centroids of facets lie inside the sphere by less than 0.4 %, 0.005 in density here.
    for (const double density : {0.42, 0.5, 0.58})
      CHECK(fit(*engine, icosphere(3, radius_at(density))).corrupt_area_fraction == 0);
    for (const double density : {0.1, 0.38, 0.62, 0.9}) {
      const FitReport report = fit(*engine, icosphere(3, radius_at(density)));
      CHECK(report.corrupt_area_fraction == doctest::Approx(1).epsilon(1e-12));
      CHECK(sum(engine->download(report.corrupt)) == 1280);
    }
  }
}

TEST_CASE("a displaced sphere is corrupt where its centroids are off, as in a serial count") {
  for (const auto& engine : back_ends()) {
    const Mesh mesh = icosphere(3, kRadius, {0.5, 0.3, -0.2});
    double area = 0, corrupt = 0, flipped = 0;
    std::vector<float> flags;
    for (const auto& t : mesh.triangles) {
      const Vec3d a = static_cast<Vec3d>(mesh.positions[t[0]]), b = static_cast<Vec3d>(mesh.positions[t[1]]);
      const Vec3d c = static_cast<Vec3d>(mesh.positions[t[2]]), centroid = (1.0 / 3) * (a + b + c);
      const bool off = std::fabs(std::exp(-dot(centroid, centroid) / (2 * kWidth * kWidth)) - 0.5) > 0.1;
      flags.push_back(off ? 1.0F : 0.0F);
      area += triangle_area(mesh, t);
      corrupt += off ? triangle_area(mesh, t) : 0;
      flipped += dot(cross(b - a, c - a), centroid) < 0 ? triangle_area(mesh, t) : 0;  // against the outward direction
    }
    const FitReport report = fit(*engine, mesh);
    CHECK(report.corrupt_area_fraction == doctest::Approx(corrupt / area).epsilon(1e-6));
    CHECK(report.corrupt_area_fraction > 0.4);
    CHECK(report.flipped_area_fraction == doctest::Approx(flipped / area).epsilon(1e-6));
    CHECK(engine->download(report.corrupt) == flags);
  }
}

TEST_CASE("a mesh beyond the reach of all atoms is corrupt, not flipped") {
  for (const auto& engine : back_ends()) {
    const FitReport report = fit(*engine, icosphere(2, 3.0, {100, 0, 0}));
    CHECK(report.corrupt_area_fraction == doctest::Approx(1).epsilon(1e-12));
    CHECK(report.flipped_area_fraction == 0);
  }
}

TEST_CASE("irregularity is the mean length of the umbrella Laplacian") {
  Random random(100);
  const Mesh mesh = moved(icosphere(3, kRadius), [&](Vec3d p) { return p + random.in_box(0.05); });
  std::vector<Vec3d> sums(mesh.positions.size());
  std::vector<int> degree(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {  // each neighbour once: the one that follows
      sums[t[c]] += static_cast<Vec3d>(mesh.positions[t[(c + 1) % 3]]);
      ++degree[t[c]];
    }
  }
  double mean = 0;
  for (std::size_t v = 0; v < sums.size(); ++v) {
    mean +=
        norm((1.0 / degree[v]) * sums[v] - static_cast<Vec3d>(mesh.positions[v])) / static_cast<double>(sums.size());
  }
  for (const auto& engine : back_ends())
    CHECK(fit(*engine, mesh).irregularity_A == doctest::Approx(mean).epsilon(1e-5));
}

TEST_CASE("a projected real surface fits its own density") {
  const auto path = real_input("ubq/ubq.pqr");
  if (!path) return;
  const AtomSet atoms = read_atoms(*path);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto surface = engine->isosurface(engine->density(uploaded, 1.0), 0.5F);
    const FitReport report = engine->fit(engine->project(surface, uploaded, 0.5F, 0.5), uploaded, 0.5F);
    std::printf("own surface of ubiquitin, %s: corrupt %.3f %%, flipped %.3f %%, irregularity %.3f A\n",
                engine->back_end().c_str(), 100 * report.corrupt_area_fraction, 100 * report.flipped_area_fraction,
                report.irregularity_A);
    CHECK(report.corrupt_area_fraction < 0.01);
    CHECK(report.flipped_area_fraction < 0.005);
    CHECK(report.irregularity_A < 0.4);
  }
}

TEST_SUITE_END();
