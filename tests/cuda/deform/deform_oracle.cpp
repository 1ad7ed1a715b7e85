// deform_oracle.cpp: the force iteration against a serial double-precision form written from the method's description.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/read_atoms.h"
#include "cuda/surface/shapes.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::DeformOptions;
using espdiff::Grid;
using espdiff::Interpolation;

namespace {

/// The field of a density: value and gradient at the lattice points, interpolated in between.
class FieldOracle {
 public:
  struct Sample {
    double value;
    Vec3d gradient;
  };

  FieldOracle(Grid field, bool tricubic) : grid_(std::move(field)), tricubic_(tricubic) {}

  Sample at(Vec3d p) const {
    std::array<std::array<double, 4>, 3> weight{};
    std::array<int, 3> base{};
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t a = static_cast<std::size_t>(axis);
      const double c = (p[axis] - grid_.lattice.origin[axis]) / grid_.lattice.step[a][axis];
      base[a] = static_cast<int>(std::floor(c));
      weight[a] = weights(c - std::floor(c));
    }
    Sample sum{0, {}};
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const double w = weight[0][static_cast<std::size_t>(i)] * weight[1][static_cast<std::size_t>(j)] *
                           weight[2][static_cast<std::size_t>(k)];
          if (w == 0) continue;
          const int x = base[0] + i - 1, y = base[1] + j - 1, z = base[2] + k - 1;
          sum.value += w * value(x, y, z);
          sum.gradient += w * gradient(x, y, z);
        }
      }
    }
    return sum;
  }

 private:
  /// Interpolates four points at t between the second and the third.
  std::array<double, 4> weights(double t) const {
    if (!tricubic_) return {0, 1 - t, t, 0};
    // Catmull-Rom: the cubic through p1 and p2 with slopes (p2 - p0) / 2 and (p3 - p1) / 2, in Hermite's form.
    const double h00 = 2 * t * t * t - 3 * t * t + 1, h10 = t * t * t - 2 * t * t + t;
    const double h01 = -2 * t * t * t + 3 * t * t, h11 = t * t * t - t * t;
    return {-h10 / 2, h00 - h11 / 2, h01 + h10 / 2, h11 / 2};
  }
  double value(int i, int j, int k) const {
    const auto& n = grid_.lattice.size;
    return static_cast<double>(
        grid_.values[static_cast<std::size_t>(i) +
                     static_cast<std::size_t>(n[0]) *
                         (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(k))]);
  }
  Vec3d gradient(int i, int j, int k) const {
    const double h = 2 * grid_.lattice.step[0].x;
    return {(value(i + 1, j, k) - value(i - 1, j, k)) / h, (value(i, j + 1, k) - value(i, j - 1, k)) / h,
            (value(i, j, k + 1) - value(i, j, k - 1)) / h};
  }

  Grid grid_;
  bool tricubic_;
};

struct OracleResult {
  std::vector<Vec3d> positions;
  std::vector<double> closest_call;  ///< [vertex] smallest |field| at which its side was determined
};

/// x += sigma (mu f_ext + (1 - mu) g f_int), f_ext = s n, f_int the tangential part of (1 - rho) L - rho L2, where L
/// may be taken relative to its values at the start.
OracleResult deform_oracle(const Mesh& mesh, const FieldOracle& field, const DeformOptions& options) {
  const std::size_t n = mesh.positions.size();
  std::vector<std::set<std::uint32_t>> ring(n);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) {
        if (a != b) ring[a].insert(b);
      }
    }
  }
  const auto umbrella = [&](const std::vector<Vec3d>& x) {
    std::vector<Vec3d> result(n);
    for (std::size_t v = 0; v < n; ++v) {
      for (const std::uint32_t u : ring[v]) result[v] += (1.0 / static_cast<double>(ring[v].size())) * (x[u] - x[v]);
    }
    return result;
  };
  OracleResult result;
  for (const Vec3f& p : mesh.positions) result.positions.push_back(static_cast<Vec3d>(p));
  std::vector<double> strength(n);
  std::vector<bool> was_inside(n);
  result.closest_call.assign(n, 1e9);
  for (std::size_t v = 0; v < n; ++v) {
    const double value = field.at(result.positions[v]).value;
    was_inside[v] = value > 0;
    strength[v] = was_inside[v] ? -1 : 1;
    result.closest_call[v] = std::fabs(value);
  }
  const std::vector<Vec3d> rest = umbrella(result.positions);
  std::vector<Vec3d> last(n);  // movement
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    std::vector<Vec3d> l = umbrella(result.positions);
    for (std::size_t v = 0; v < n && options.rest_shape; ++v) l[v] = l[v] - rest[v];
    const std::vector<Vec3d> l2 = umbrella(l);
    for (std::size_t v = 0; v < n; ++v) {
      const auto sample = field.at(result.positions[v]);
      result.closest_call[v] = std::min(result.closest_call[v], std::fabs(sample.value));
      if ((sample.value > 0) != was_inside[v]) {
        strength[v] *= -0.5;
        was_inside[v] = !was_inside[v];
      }
      const Vec3d normal = (1 / norm(sample.gradient)) * sample.gradient;
      const Vec3d internal = options.sigma * (1 - options.mu) * options.tangential_gain *
                                 ((1 - options.rho) * l[v] - options.rho * l2[v]) +
                             options.momentum * last[v];
      last[v] = options.sigma * options.mu * strength[v] * normal + internal - dot(internal, normal) * normal;
      result.positions[v] += last[v];
    }
  }
  return result;
}

struct Comparison {
  double worst = 0, usual = 0;  ///< of all vertices, and of 99.9 % of them
  std::size_t n = 0, n_undecided = 0;
};

Comparison compare_to_oracle(Engine& engine, const AtomSet& atoms, const DeformOptions& options) {
  const auto density = engine.density(upload(engine, atoms), 1.0);
  // From the surface at 0.4 to that at 0.55: the vertices cross it, and not all at once.
  const auto start = engine.isosurface(density, 0.4F);
  const auto field = engine.density_field(density, 0.55F);
  const Mesh after = engine.download(engine.deform(start, field, options, "deform", {}, nullptr));
  const FieldOracle field_oracle(engine.download(field), options.interpolation == Interpolation::kTricubic);
  const OracleResult exact = deform_oracle(engine.download(start), field_oracle, options);
  Comparison c;
  std::vector<double> errors;
  for (std::size_t v = 0; v < after.positions.size(); ++v) {
    ++c.n;
    // The side of a vertex is undetermined where the field is zero to single precision.
    if (exact.closest_call[v] < 2e-6) {
      ++c.n_undecided;
      continue;
    }
    errors.push_back(norm(static_cast<Vec3d>(after.positions[v]) - exact.positions[v]));
  }
  std::sort(errors.begin(), errors.end());
  c.usual = errors[errors.size() * 999 / 1000];
  c.worst = errors.back();
  return c;
}

void check_against_oracle(const AtomSet& atoms, const char* name) {
  for (const auto& engine : back_ends()) {
    for (const Interpolation interpolation : {Interpolation::kTrilinear, Interpolation::kTricubic}) {
      for (const int n_iterations : {1, 2, 10}) {
        DeformOptions options;
        options.interpolation = interpolation;
        options.max_iterations = n_iterations;
        const Comparison c = compare_to_oracle(*engine, atoms, options);
        std::printf(
            "deform, %s, %s, %s, %d iterations: 99.9 %% of the vertices within %.1e A, all within %.1e A (%zu of %zu "
            "undecided)\n",
            engine->back_end().c_str(), name, interpolation == Interpolation::kTrilinear ? "trilinear" : "tricubic",
            n_iterations, c.usual, c.worst, c.n_undecided, c.n);
        CAPTURE(n_iterations);
        CHECK(c.usual < 1e-5);
        CHECK(c.worst < 1e-4);  // deep in a crevice the gradient nearly vanishes, and its direction amplifies rounding
        CHECK(c.n_undecided * 300 <= c.n);
      }
    }
  }
}

}  // namespace

TEST_SUITE_BEGIN("deform");

TEST_CASE("iterations on a random cloud equal those of a serial double-precision form") {
  check_against_oracle(random_cloud(150, 140), "cloud");
}

TEST_CASE("iterations on a real surface equal those of a serial double-precision form") {
  const auto path = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr");
  if (!path) return;
  check_against_oracle(read_atoms(*path), "1AJJ");
}

TEST_CASE("each force alone, a gain, momentum and a rest shape agree with the serial form") {
  const AtomSet atoms = random_cloud(100, 141);
  for (const auto& engine : back_ends()) {
    for (const double mu : {0.0, 0.5, 1.0}) {
      for (const double gain : {0.0, 1.0, 3.0}) {
        for (const bool rest_shape : {false, true}) {
          for (const double momentum : {0.0, 0.7}) {
            DeformOptions options;
            options.mu = mu;
            options.tangential_gain = gain;
            options.rest_shape = rest_shape;
            options.momentum = momentum;
            options.max_iterations = 5;
            CAPTURE(mu);
            CAPTURE(gain);
            CAPTURE(rest_shape);
            CAPTURE(momentum);
            const Comparison c = compare_to_oracle(*engine, atoms, options);
            CHECK(c.worst < 1e-5);
            CHECK(c.n_undecided * 300 <= c.n);
          }
        }
      }
    }
  }
}

TEST_SUITE_END();
