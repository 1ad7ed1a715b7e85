// deform.cpp: the force iteration on shapes with known answers: spheres onto spheres, a surface onto itself, options,
// cancellation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/progress.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::DeformOptions;
using espdiff::DeformReport;
using espdiff::FieldPtr;
using espdiff::Interpolation;
using espdiff::MeshPtr;

namespace {

constexpr double kSpacing = 0.8;
const double kRadiusPerWidth = std::sqrt(2 * std::log(2.0));  // isovalue 0.5

struct Target {
  FieldPtr field;
  Vec3d centre;
  double radius;
};

Target sphere_target(Engine& engine, Vec3d centre, double width, bool distance) {
  const auto atoms = upload(engine, one_gaussian(centre, width));
  const auto density = engine.density(atoms, kSpacing);
  const auto surface = engine.project(engine.isosurface(density, 0.5F), atoms, 0.5F, 0.5);
  return {distance ? engine.distance_field(density, 0.5F, surface, 0.75, {}) : engine.density_field(density, 0.5F),
          centre, width * kRadiusPerWidth};
}

/// Largest distance of a vertex from the sphere.
double worst_miss(const Mesh& mesh, const Target& target) {
  double worst = 0;
  for (const Vec3f& p : mesh.positions)
    worst = std::max(worst, std::fabs(norm(static_cast<Vec3d>(p) - target.centre) - target.radius));
  return worst;
}

double mean_distance(const Mesh& a, const Mesh& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.positions.size(); ++v)
    sum += norm(static_cast<Vec3d>(a.positions[v]) - static_cast<Vec3d>(b.positions[v]));
  return sum / static_cast<double>(a.positions.size());
}

DeformOptions options_with(Interpolation interpolation) {
  DeformOptions options;
  options.min_displacement_A = 1e-3 * kSpacing;
  options.interpolation = interpolation;
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("deform");

TEST_CASE("a sphere deforms onto a shifted, a larger and a smaller sphere, in both fields and interpolations") {
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(icosphere(3, 2.5 * kRadiusPerWidth));
    for (const bool distance : {false, true}) {
      for (const auto& [centre, width] :
           {std::pair<Vec3d, double>{{0.9, -0.5, 0.4}, 2.5}, {{0, 0, 0}, 3.3}, {{0.2, 0.1, 0}, 1.9}}) {
        for (const Interpolation interpolation : {Interpolation::kTrilinear, Interpolation::kTricubic}) {
          const Target target = sphere_target(*engine, centre, width, distance);
          DeformReport report;
          const MeshPtr mapped =
              engine->deform(source, target.field, options_with(interpolation), "deform", {}, &report);
          const Mesh mesh = engine->download(mapped);
          CAPTURE(distance);
          const double captured_width = width;  // a structured binding cannot be captured
          CAPTURE(captured_width);
          CAPTURE(static_cast<int>(interpolation));
          CHECK(report.converged);
          CHECK(report.mean_displacement_A < 1e-3 * kSpacing);
          CHECK(report.iterations < 300);
          CHECK(mesh.triangles == icosphere(3, 1).triangles);
          CHECK(manifold_fault(mesh) == "");
          CHECK(signed_volume(mesh) > 0);
          // Linear interpolation of a Gaussian errs by spacing^2 / 8 times its curvature over its slope: 0.05 A at 0.8
          // A. In the distance field a cell mixes densities and distances, which moves the crossing: 0.15 A measured
          // with linear interpolation, and see below for the cubic one.
          if (!distance || interpolation == Interpolation::kTrilinear) {
            CHECK(worst_miss(mesh, target) < (distance ? 0.2 : interpolation == Interpolation::kTricubic ? 0.05 : 0.1));
          }
        }
      }
    }
  }
}

TEST_CASE("trilinear and tricubic sampling agree within the lattice's error") {
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(icosphere(3, 2.5 * kRadiusPerWidth));
    const Target target = sphere_target(*engine, {0.5, 0.3, -0.2}, 2.8, false);
    Mesh mapped[2];
    for (const int i : {0, 1}) {
      const auto options = options_with(i == 0 ? Interpolation::kTrilinear : Interpolation::kTricubic);
      mapped[i] = engine->download(engine->deform(source, target.field, options, "deform", {}, nullptr));
    }
    CHECK(mean_distance(mapped[0], mapped[1]) < 0.05);
    CHECK(mean_distance(mapped[0], mapped[1]) > 1e-4);  // they are two
  }
}

TEST_CASE("tricubic sampling of the distance field finds the surface as well as trilinear") {
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(icosphere(3, 2.5 * kRadiusPerWidth));
    const Target target = sphere_target(*engine, {0.9, -0.5, 0.4}, 2.5, true);
    const auto miss = [&](Interpolation interpolation) {
      const auto mapped = engine->deform(source, target.field, options_with(interpolation), "deform", {}, nullptr);
      return worst_miss(engine->download(mapped), target);
    };
    const double linear = miss(Interpolation::kTrilinear), cubic = miss(Interpolation::kTricubic);
    std::printf("distance field, %s: trilinear misses the sphere by %.3f A, tricubic by %.3f A\n",
                engine->back_end().c_str(), linear, cubic);
    CHECK(cubic < 0.2);
  }
}

TEST_CASE("the vertices' paths are no shorter than straight lines, and longer where they oscillate about the surface") {
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(icosphere(3, 2.5 * kRadiusPerWidth));
    const Target target = sphere_target(*engine, {0.9, -0.5, 0.4}, 2.5, false);
    const Mesh before = engine->download(source);
    DeformOptions options = options_with(Interpolation::kTrilinear);
    options.min_displacement_A = 0;
    std::vector<float> earlier(before.positions.size(), 0.0F);
    for (const int n : {1, 20, 80}) {
      options.max_iterations = n;
      DeformReport report;
      const Mesh after = engine->download(engine->deform(source, target.field, options, "deform", {}, &report));
      const std::vector<float> ways = engine->download(report.path_length);
      float least = 1, shrunk = 0;
      double excess = 0;
      for (std::size_t v = 0; v < ways.size(); ++v) {
        const float straight = norm(after.positions[v] - before.positions[v]);
        least = std::min(least, ways[v] - straight);
        shrunk = std::max(shrunk, earlier[v] - ways[v]);
        excess += static_cast<double>(ways[v] - straight) / static_cast<double>(ways.size());
      }
      CHECK(least > -1e-5F);
      CHECK(shrunk <= 0);
      if (n == 1) CHECK(excess < 1e-5);
      if (n == 80) CHECK(excess > 0.02);
      earlier = ways;
    }
  }
}

TEST_CASE("the mean displacement decreases and the iterations asked for are made") {
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(icosphere(3, 2.5 * kRadiusPerWidth));
    const Target target = sphere_target(*engine, {0.9, -0.5, 0.4}, 2.5, true);
    double last = 1;
    for (const int n : {1, 7, 25, 50, 100}) {
      DeformOptions options = options_with(Interpolation::kTrilinear);
      options.min_displacement_A = 0;
      options.max_iterations = n;
      DeformReport report;
      engine->deform(source, target.field, options, "deform", {}, &report);
      CHECK(report.iterations == n);
      CHECK_FALSE(report.converged);
      CHECK(report.mean_displacement_A < last);
      CHECK(report.mean_displacement_A > 0);
      last = report.mean_displacement_A;
    }
    DeformOptions options = options_with(Interpolation::kTrilinear);
    options.max_iterations = 0;
    DeformReport report;
    const auto same = engine->deform(source, target.field, options, "deform", {}, &report);
    CHECK(report.iterations == 0);
    CHECK(engine->download(same).positions == engine->download(source).positions);
  }
}

TEST_CASE("the first step toward a far surface is sigma mu along the field") {
  for (const auto& engine : back_ends()) {
    // Without internal force each vertex outside moves sigma inward, each inside outward.
    const Target target = sphere_target(*engine, {0, 0, 0}, 2.5, false);
    for (const double factor : {0.8, 1.25}) {
      const Mesh sphere = icosphere(2, factor * target.radius);
      DeformOptions options = options_with(Interpolation::kTricubic);
      options.mu = 1;
      options.max_iterations = 1;
      const Mesh after =
          engine->download(engine->deform(engine->upload_mesh(sphere), target.field, options, "deform", {}, nullptr));
      double worst = 0;
      for (std::size_t v = 0; v < after.positions.size(); ++v) {
        const Vec3d before = static_cast<Vec3d>(sphere.positions[v]);
        const Vec3d expected = (1 + (factor < 1 ? 0.1 : -0.1) / norm(before)) * before;
        worst = std::max(worst, norm(static_cast<Vec3d>(after.positions[v]) - expected));
      }
      CHECK(worst < 0.01);  // the lattice's gradient points a few degrees off
    }
  }
}

TEST_CASE("a regularized surface mapped onto itself stays where it is") {
  const auto path = real_input("ubq/ubq.pqr");
  AtomSet atoms = path ? read_atoms(*path) : random_cloud(400, 130);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto density = engine->density(uploaded, 1.0);
    const auto surface = engine->project(engine->isosurface(density, 0.5F), uploaded, 0.5F, 0.5);
    DeformOptions regularize;
    regularize.mu = 0.5;
    regularize.max_iterations = 500;
    const auto field = engine->density_field(density, 0.5F);
    const auto start =
        engine->project(engine->deform(surface, field, regularize, "regularize", {}, nullptr), uploaded, 0.5F, 0.5);
    DeformReport report;
    const auto mapped =
        engine->project(engine->deform(start, field, DeformOptions{}, "deform", {}, &report), uploaded, 0.5F, 0.5);
    std::vector<float> moved_by = engine->download(engine->displacement(start, mapped));
    std::sort(moved_by.begin(), moved_by.end());
    double mean = 0;
    for (const float d : moved_by) mean += static_cast<double>(d) / static_cast<double>(moved_by.size());
    std::printf("self-map, %s: mean %.4f A, 95 %% %.4f A, largest %.3f A, %d iterations\n", engine->back_end().c_str(),
                mean, static_cast<double>(moved_by[moved_by.size() * 95 / 100]), static_cast<double>(moved_by.back()),
                report.iterations);
    CHECK(report.converged);
    CHECK(mean < 0.03);  // what is left of the tangential creep, a tenth of an edge at the most
    CHECK(moved_by.back() < 0.5F);
  }
}

/// Mean length of the umbrella Laplacian, Angstrom.
double irregularity(const Mesh& mesh) {
  std::vector<std::set<std::uint32_t>> rings(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) {
        if (a != b) rings[a].insert(b);
      }
    }
  }
  double sum = 0;
  for (std::size_t v = 0; v < rings.size(); ++v) {
    Vec3d mean;
    for (const std::uint32_t u : rings[v])
      mean += (1.0 / static_cast<double>(rings[v].size())) * static_cast<Vec3d>(mesh.positions[u]);
    sum += norm(mean - static_cast<Vec3d>(mesh.positions[v]));
  }
  return sum / static_cast<double>(rings.size());
}

TEST_CASE("momentum regularizes in half the iterations") {
  const auto path = real_input("ubq/ubq.pqr");
  const AtomSet atoms = path ? read_atoms(*path) : random_cloud(400, 130);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto density = engine->density(uploaded, 1.0);
    const auto surface = engine->project(engine->isosurface(density, 0.5F), uploaded, 0.5F, 0.5);
    const auto field = engine->density_field(density, 0.5F);
    DeformReport reports[2];
    double left[2];
    for (const bool with_momentum : {false, true}) {
      DeformOptions options;
      options.mu = 0.5;
      options.tangential_gain = 10;
      options.max_iterations = 500;
      options.min_displacement_A = with_momentum ? 7.5e-3 : 2.5e-3;
      if (with_momentum) options.momentum = 0.7;
      const auto mesh = engine->deform(surface, field, options, "regularize", {}, &reports[with_momentum]);
      left[with_momentum] = irregularity(engine->download(engine->project(mesh, uploaded, 0.5F, 0.5)));
    }
    std::printf("regularization, %s: %d iterations to an irregularity of %.5f A, with momentum %d to %.5f A\n",
                engine->back_end().c_str(), reports[0].iterations, left[0], reports[1].iterations, left[1]);
    CHECK(reports[1].converged);
    CHECK(2 * reports[1].iterations <= reports[0].iterations + 5);  // looked at after every fifth
    CHECK(left[1] < left[0]);
    CHECK(left[1] < 0.5 * irregularity(engine->download(surface)));
  }
}

TEST_CASE("with a rest shape a surface mapped onto itself does not creep") {
  const AtomSet atoms = random_cloud(250, 131);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto density = engine->density(uploaded, 1.0);
    const auto start = engine->project(engine->isosurface(density, 0.5F), uploaded, 0.5F, 0.5);
    const auto field = engine->density_field(density, 0.5F);
    const auto mean_shift = [&](bool rest_shape) {
      DeformOptions options;
      options.rest_shape = rest_shape;
      options.min_displacement_A = 0;
      options.max_iterations = 200;
      const auto mapped =
          engine->project(engine->deform(start, field, options, "deform", {}, nullptr), uploaded, 0.5F, 0.5);
      double sum = 0;
      for (const float d : engine->download(engine->displacement(start, mapped))) sum += static_cast<double>(d);
      return sum / static_cast<double>(engine->n_vertices(start));
    };
    const double resting = mean_shift(true), creeping = mean_shift(false);
    std::printf("self-map of a raw surface, %s: mean shift %.4f A with a rest shape, %.4f A without\n",
                engine->back_end().c_str(), resting, creeping);
    CHECK(resting < 0.02);
    CHECK(creeping > 5 * resting);
  }
}

TEST_CASE("deform: parameters out of range are refused with the value") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(icosphere(1, 3.0));
    const FieldPtr field = sphere_target(*engine, {0, 0, 0}, 2.5, false).field;
    const auto message = [&](auto change) {
      DeformOptions options;
      change(options);
      CHECK_THROWS_AS(engine->deform(mesh, field, options, "deform", {}, nullptr), espdiff::InputError);
      return message_of([&] { engine->deform(mesh, field, options, "deform", {}, nullptr); });
    };
    CHECK(message([](DeformOptions& o) { o.sigma = 0; }) == "sigma 0 is not positive; 0.1 is usual");
    CHECK(message([](DeformOptions& o) { o.sigma = -0.1; }) == "sigma -0.1 is not positive; 0.1 is usual");
    CHECK(message([](DeformOptions& o) { o.mu = 1.5; }) == "mu 1.5 is not between 0 and 1");
    CHECK(message([](DeformOptions& o) { o.rho = -0.5; }) == "rho -0.5 is not between 0 and 1");
    CHECK(message([](DeformOptions& o) { o.max_iterations = -1; }) == "the number of iterations, -1, is negative");
    CHECK(message([](DeformOptions& o) { o.min_displacement_A = -1; }) ==
          "the smallest displacement, -1 A, is negative");
    CHECK(message([](DeformOptions& o) { o.tangential_gain = -1; }) ==
          "the tangential gain, -1, is negative; 1 is the plain iteration");
    CHECK(message([](DeformOptions& o) { o.tangential_gain = 100; }).find("where the iteration becomes unstable") !=
          std::string::npos);
    CHECK(message([](DeformOptions& o) { o.momentum = 1; }) ==
          "the momentum, 1, is not from 0 to below 1; 0.7 is usual");
    message([](DeformOptions& o) { o.momentum = -0.1; });
    message([&](DeformOptions& o) { o.momentum = nan; });
    message([&](DeformOptions& o) { o.tangential_gain = nan; });
    message([&](DeformOptions& o) { o.sigma = nan; });
    message([&](DeformOptions& o) { o.mu = nan; });
    message([&](DeformOptions& o) { o.rho = nan; });
    message([&](DeformOptions& o) { o.min_displacement_A = nan; });
  }
}

TEST_CASE("deform reports progress under the name given and stops when cancelled") {
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(icosphere(1, 3.0));
    const FieldPtr field = sphere_target(*engine, {1, 0, 0}, 2.5, false).field;
    std::vector<double> fractions;
    bool named = true;
    const espdiff::Progress listening([&](const std::string& stage, double fraction) {
      named = named && stage == "a stage";
      fractions.push_back(fraction);
    });
    DeformOptions options;
    options.min_displacement_A = 0;
    options.max_iterations = 100;
    engine->deform(mesh, field, options, "a stage", listening, nullptr);
    CHECK(named);
    CHECK(fractions.size() > 5);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
    CHECK(fractions.back() == 1.0);

    int n_reports = 0;
    espdiff::Progress* self = nullptr;
    espdiff::Progress cancelling([&](const std::string&, double) {
      if (++n_reports == 3) self->request_cancel();
    });
    self = &cancelling;
    CHECK_THROWS_AS(engine->deform(mesh, field, options, "deform", cancelling, nullptr), espdiff::Cancelled);
    CHECK(n_reports == 3);
  }
}

TEST_SUITE_END();
