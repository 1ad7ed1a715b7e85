// vector_flow.cpp: gradient vector flow: radial around a sphere, the equation itself, convergence, spacings, two
// surfaces, refusals.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/progress.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::FieldPtr;
using espdiff::Grid;
using espdiff::GridPtr;
using espdiff::VectorFlowOptions;
using espdiff::VectorFlowReport;

namespace {

const Vec3d kCentre{0.2, 0.1, -0.3};

struct Flow {
  espdiff::Lattice lattice;
  std::vector<Vec3f> u;
  std::vector<float> scalar;
  VectorFlowReport report;
};

Flow flow_of(Engine& engine, const GridPtr& target, const GridPtr& source = nullptr,
             const VectorFlowOptions& options = {}) {
  Flow flow;
  const FieldPtr field = engine.gvf_field(target, source, kIsovalue, options, {}, &flow.report);
  const Grid scalar = engine.download(field);
  flow.lattice = scalar.lattice;
  flow.scalar = scalar.values;
  flow.u = engine.download_gradient(field);
  return flow;
}

GridPtr density_of(Engine& engine, const AtomSet& atoms, double spacing) {
  return engine.density(upload(engine, atoms), spacing);
}

VectorFlowOptions with(double weight, double tolerance, int max_sweeps) {
  VectorFlowOptions options;
  options.weight_A2 = weight;
  options.tolerance = tolerance;
  options.max_sweeps = max_sweeps;
  return options;
}

double cosine(Vec3f a, Vec3d b) { return dot(static_cast<Vec3d>(a), b) / (norm(static_cast<Vec3d>(a)) * norm(b)); }

/// Trilinear sample of the flow's direction, in double precision.
Vec3d sample(const Flow& flow, Vec3d p) {
  const Vec3d at = (1 / flow.lattice.step[0].x) * (p - flow.lattice.origin);
  const std::size_t nx = static_cast<std::size_t>(flow.lattice.size[0]),
                    ny = static_cast<std::size_t>(flow.lattice.size[1]);
  const double x = std::floor(at.x), y = std::floor(at.y), z = std::floor(at.z);
  Vec3d sum{};
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2 & 1;
    const double weight = (i != 0 ? at.x - x : 1 - (at.x - x)) * (j != 0 ? at.y - y : 1 - (at.y - y)) *
                          (k != 0 ? at.z - z : 1 - (at.z - z));
    const std::size_t point = static_cast<std::size_t>(x) + static_cast<std::size_t>(i) +
                              nx * (static_cast<std::size_t>(y) + static_cast<std::size_t>(j) +
                                    ny * (static_cast<std::size_t>(z) + static_cast<std::size_t>(k)));
    sum += weight * static_cast<Vec3d>(flow.u[point]);
  }
  return sum;
}

}  // namespace

TEST_SUITE_BEGIN("gradient vector flow");

TEST_CASE("around a sphere the flow points to its centre, at any spacing, and is 1 long on it") {
  const double width = 3.0, radius = width * std::sqrt(2 * std::log(2.0));
  for (const auto& engine : back_ends()) {
    for (const double spacing : {1.0, 0.7, 0.5}) {
      const Flow flow = flow_of(*engine, density_of(*engine, one_gaussian(kCentre, width), spacing));
      CAPTURE(spacing);
      CHECK(flow.report.converged);
      double worst = 1, on_surface = 0;
      std::size_t n_far = 0, n_on = 0;
      for (std::size_t p = 0; p < flow.u.size(); ++p) {
        const Vec3d inward = kCentre - lattice_point(flow.lattice, p);
        CHECK(std::isfinite(flow.u[p].x + flow.u[p].y + flow.u[p].z));
        if (norm(inward) < 1) continue;  // at the centre there is no direction
        worst = std::min(worst, cosine(flow.u[p], inward));
        n_far += norm(inward) > radius + 5 ? 1 : 0;
        if (std::fabs(norm(inward) - radius) > 0.3) continue;
        on_surface += static_cast<double>(norm(flow.u[p]));
        ++n_on;
      }
      CHECK(n_far > 1000);
      CHECK(worst > 0.97);  // the lattice's corners, whose border is a cube
      CHECK(on_surface / static_cast<double>(n_on) == doctest::Approx(1).epsilon(0.15));
    }
  }
}

TEST_CASE("the scalar is density minus isovalue, with the signs and crossings of the density field") {
  for (const auto& engine : back_ends()) {
    const GridPtr density = density_of(*engine, random_cloud(60, 5), 1.0);
    CHECK(flow_of(*engine, density).scalar == engine->download(engine->density_field(density, kIsovalue)).values);
  }
}

TEST_CASE("away from the surface the flow is harmonic: each point is the mean of its neighbours") {
  for (const auto& engine : back_ends()) {
    const GridPtr density = density_of(*engine, random_cloud(60, 5), 1.0);
    const Flow flow = flow_of(*engine, density, nullptr, with(0.2, 1e-5, 5000));
    REQUIRE(flow.report.converged);
    const std::size_t nx = static_cast<std::size_t>(flow.lattice.size[0]),
                      ny = static_cast<std::size_t>(flow.lattice.size[1]),
                      nz = static_cast<std::size_t>(flow.lattice.size[2]);
    double worst = 0, largest = 0;
    std::size_t n_free = 0;
    for (std::size_t k = 1; k + 1 < nz; ++k) {
      for (std::size_t j = 1; j + 1 < ny; ++j) {
        for (std::size_t i = 1; i + 1 < nx; ++i) {
          const std::size_t p = i + nx * (j + ny * k);
          if (std::fabs(flow.scalar[p]) < 0.25F) continue;  // imposed by the surface's normals
          const Vec3f mean = (1.0F / 6.0F) * (flow.u[p - 1] + flow.u[p + 1] + flow.u[p - nx] + flow.u[p + nx] +
                                              flow.u[p - nx * ny] + flow.u[p + nx * ny]);
          worst = std::max(worst, static_cast<double>(norm(mean - flow.u[p])));
          largest = std::max(largest, static_cast<double>(norm(flow.u[p])));
          ++n_free;
        }
      }
    }
    CHECK(n_free > 5000);
    CHECK(worst < 5e-5);
    CHECK(largest > 0.5);
  }
}

TEST_CASE("sweeps lower the residual below the tolerance, at any weight and spacing") {
  for (const auto& engine : back_ends()) {
    const AtomSet atoms = random_cloud(60, 6);
    for (const double spacing : {1.5, 1.0, 0.6}) {
      const GridPtr density = density_of(*engine, atoms, spacing);
      for (const double weight : {0.01, 0.2, 20.0}) {
        CAPTURE(spacing);
        CAPTURE(weight);
        const VectorFlowReport few = flow_of(*engine, density, nullptr, with(weight, 1e-9, 10)).report,
                               more = flow_of(*engine, density, nullptr, with(weight, 1e-9, 100)).report,
                               all = flow_of(*engine, density, nullptr, with(weight, 1e-3, 3000)).report;
        CHECK(few.sweeps == 10);
        CHECK_FALSE(few.converged);
        CHECK(more.residual < 0.7 * few.residual);
        CHECK(all.converged);
        CHECK(all.residual < 1e-3);
        CHECK(all.sweeps < 1000);
      }
    }
  }
}

TEST_CASE("the flow converges with finer lattices and tighter tolerances") {
  for (const auto& engine : back_ends()) {
    const AtomSet atoms = random_cloud(60, 7);
    const auto at = [&](double spacing, double tolerance) {
      return flow_of(*engine, density_of(*engine, atoms, spacing), nullptr, with(0.2, tolerance, 5000));
    };
    const Flow finest = at(0.4, 1e-5);
    const auto difference = [&](const Flow& flow) {
      Random random(8);
      double sum = 0;
      for (int n = 0; n < 2000; ++n) {
        const Vec3d p = random.in_box(7), a = sample(flow, p), b = sample(finest, p);
        sum += norm(a - b);
      }
      return sum / 2000;
    };
    const double coarse = difference(at(1.0, 1e-5)), fine = difference(at(0.55, 1e-5));
    std::printf("gradient vector flow, %s: mean difference from 0.4 A: %.3f at 1 A, %.3f at 0.55 A\n",
                engine->back_end().c_str(), coarse, fine);
    CHECK(fine < 0.6 * coarse);
    CHECK(coarse < 0.3);
    const Flow exact = at(1.0, 1e-6), default_one = at(1.0, 1e-3);
    double worst = 0;
    for (std::size_t p = 0; p < exact.u.size(); ++p)
      worst = std::max(worst, static_cast<double>(norm(exact.u[p] - default_one.u[p])));
    CHECK(worst < 0.1);  // 0.066 at a corner of the lattice
  }
}

TEST_CASE("with two surfaces the flow follows each one's normals at it") {
  // A large ball around the target's small one, off its centre: normals differ in direction.
  const double target_radius = 2.0 * std::sqrt(2 * std::log(2.0)), source_radius = 1.75 * target_radius;
  const Vec3d source_centre{2.5, 0, 0};
  for (const auto& engine : back_ends()) {
    const GridPtr target = density_of(*engine, one_gaussian({0, 0, 0}, 2.0), 0.7),
                  source = density_of(*engine, one_gaussian(source_centre, 3.5), 0.7);
    const Flow one = flow_of(*engine, target), two = flow_of(*engine, target, source);
    CHECK(two.report.converged);
    CHECK(two.scalar == one.scalar);
    double at_target = 1, at_source = 1, at_source_one_way = 1;
    for (const Vec3d& along : {Vec3d{0, 1, 0}, {0, 0, 1}, {-0.6, 0.8, 0}}) {
      at_target = std::min(at_target,
                           -dot(sample(two, target_radius * along), along) / norm(sample(two, target_radius * along)));
      const Vec3d there = source_centre + source_radius * along;
      at_source = std::min(at_source, -dot(sample(two, there), along) / norm(sample(two, there)));
      at_source_one_way = std::min(at_source_one_way, -dot(sample(one, there), along) / norm(sample(one, there)));
    }
    CHECK(at_target > 0.97);
    CHECK(at_source > 0.97);
    CHECK(at_source_one_way < 0.95);
  }
}

TEST_CASE("a sphere deforms onto another in either flow") {
  const double per_width = std::sqrt(2 * std::log(2.0));
  for (const auto& engine : back_ends()) {
    const auto start = engine->upload_mesh(icosphere(3, 2.5 * per_width));
    const GridPtr source = density_of(*engine, one_gaussian({0, 0, 0}, 2.5), 0.8);
    const Vec3d centre{1.5, -0.8, 0.6};
    const GridPtr target = density_of(*engine, one_gaussian(centre, 3.0), 0.8);
    for (const GridPtr& other : {GridPtr(), source}) {
      const FieldPtr field = engine->gvf_field(target, other, kIsovalue, {}, {}, nullptr);
      espdiff::DeformReport report;
      const Mesh mesh = engine->download(engine->deform(start, field, {}, "deform", {}, &report));
      double worst = 0;
      for (const Vec3f& p : mesh.positions)
        worst = std::max(worst, std::fabs(norm(static_cast<Vec3d>(p) - centre) - 3.0 * per_width));
      CHECK(report.converged);
      CHECK(worst < 0.1);
      CHECK(signed_volume(mesh) > 0);
    }
  }
}

TEST_CASE("gradient vector flow: options out of range are refused with the value") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& engine : back_ends()) {
    const GridPtr density = density_of(*engine, one_gaussian({0, 0, 0}, 2.0), 1.0);
    const auto message = [&](const VectorFlowOptions& options) {
      CHECK_THROWS_AS(engine->gvf_field(density, nullptr, kIsovalue, options, {}, nullptr), espdiff::InputError);
      return message_of([&] { engine->gvf_field(density, nullptr, kIsovalue, options, {}, nullptr); });
    };
    CHECK(message(with(0, 1e-3, 10)) ==
          "the weight of the gradient vector flow, 0 A^2, is not positive; 0.05 is usual");
    CHECK(message(with(0.2, -1, 10)) ==
          "the tolerance of the gradient vector flow, -1, is not positive; 0.001 is usual");
    CHECK(message(with(0.2, 1e-3, 0)) == "the gradient vector flow needs at least 1 sweep, not 0");
    message(with(nan, 1e-3, 10));
    message(with(0.2, nan, 10));
  }
}

TEST_CASE("gradient vector flow that would not fit is refused before it begins, and the density that fits is not") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const AtomSet atoms = one_gaussian({0, 0, 0}, 10.0);
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
  // 190^3 points: 27 MB of density and 70 MB with its isosurface, but 439 MB of flow.
  const auto handle = upload(*engine, atoms);
  const GridPtr density = engine->density(handle, 0.42);
  const double n_points = static_cast<double>(engine->download(density).values.size());
  REQUIRE(n_points > 4e6);
  rlimit narrow = before;
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const double room = n_points * 40;
  narrow.rlim_cur = static_cast<rlim_t>(pages * 4096 + room);
  REQUIRE(setrlimit(RLIMIT_AS, &narrow) == 0);
  const std::string flow = message_of([&] { engine->gvf_field(density, nullptr, kIsovalue, {}, {}, nullptr); }),
                    again = message_of([&] { engine->density(handle, 0.42); }),
                    finer = message_of([&] { engine->density(handle, 0.1); });
  setrlimit(RLIMIT_AS, &before);
  CHECK(flow.find("gradient vector flow on a grid of ") == 0);
  CHECK(flow.find(" GB are available; a spacing 1.") != std::string::npos);
  CHECK(again == "(nothing thrown)");
  CHECK(finer.find("a grid of spacing 0.1 A") == 0);
  CHECK(finer.find(" GB of memory, and ") != std::string::npos);
  CHECK(finer.find(" A would fit") != std::string::npos);
}

TEST_CASE("gradient vector flow reports progress and stops when cancelled") {
  for (const auto& engine : back_ends()) {
    const GridPtr density = density_of(*engine, random_cloud(60, 9), 1.0);
    std::vector<double> fractions;
    const espdiff::Progress listening([&](const std::string& stage, double fraction) {
      CHECK(stage == "gradient vector flow");
      fractions.push_back(fraction);
    });
    engine->gvf_field(density, nullptr, kIsovalue, with(0.2, 1e-9, 50), listening, nullptr);
    CHECK(fractions.size() == 6);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
    CHECK(fractions.back() == 1.0);

    int n_reports = 0;
    espdiff::Progress* self = nullptr;
    espdiff::Progress cancelling([&](const std::string&, double) {
      if (++n_reports == 2) self->request_cancel();
    });
    self = &cancelling;
    CHECK_THROWS_AS(engine->gvf_field(density, nullptr, kIsovalue, with(0.2, 1e-9, 50), cancelling, nullptr),
                    espdiff::Cancelled);
    CHECK(n_reports == 2);
  }
}

TEST_SUITE_END();
