// poisson_boltzmann.cpp: the Poisson-Boltzmann potential against analytic ones (Born, Kirkwood, Debye and Hueckel).
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

#include "cuda/potential/poisson_boltzmann_inputs.h"

using namespace espdiff_test;
using espdiff::DielectricBoundary;

namespace {

constexpr double kCoulomb = 332.0636 / (300 * 0.001987191);
constexpr double kIonsPerA3 = 6.02214076e-4;

/// 1/A, in the solvent.
double kappa_of(const PoissonBoltzmannOptions& o) {
  return std::sqrt(8 * kPi * kCoulomb * kIonsPerA3 * o.ionic_strength / o.solvent_dielectric);
}

/// A charge at distance e from the centre of a sphere of low dielectric, ions kept out of a larger one: Kirkwood, J.
/// Chem. Phys. 2, 351 (1934), by Legendre polynomials, each from the outer region inwards.
class Kirkwood {
 public:
  Kirkwood(double sphere, double exclusion, double e, const PoissonBoltzmannOptions& o)
      : sphere_(sphere), exclusion_(exclusion), e_(e), o_(o), kappa_(kappa_of(o)) {}

  /// Outside the sphere. @param cosine between the point and the charge
  double at(double r, double cosine) const {
    double sum = 0, before = 0, legendre = 1;
    for (int l = 0; l < 40; ++l) {
      sum += term(l, r) * legendre;
      const double next = ((2 * l + 1) * cosine * legendre - l * before) / (l + 1);
      before = legendre;
      legendre = next;
    }
    return sum;
  }

 private:
  /// The decaying solution beyond the ions' border, relative to there: exp(-kappa r) times a polynomial in 1/r.
  double decaying(int l, double r, double* slope = nullptr) const {
    if (kappa_ == 0) {
      if (slope != nullptr) *slope = -(l + 1) * std::pow(r, -l - 2);
      return std::pow(r, -l - 1);
    }
    const double x = kappa_ * r;
    double before = std::exp(-x) / x, now = std::exp(-x) * (1 / x + 1 / (x * x));
    if (l == 0) {
      if (slope != nullptr) *slope = -kappa_ * now;
      return before;
    }
    for (int n = 1; n < l; ++n) {
      const double next = before + (2 * n + 1) / x * now;
      before = now;
      now = next;
    }
    if (slope != nullptr) *slope = kappa_ * (-before - (l + 1) / x * now);
    return now;
  }
  double term(int l, double r) const {
    const double a = exclusion_, b = sphere_, eps_in = o_.solute_dielectric, eps_out = o_.solvent_dielectric;
    double slope = 0;
    const double edge = decaying(l, a, &slope), log_slope = a * slope / edge;
    // Between: G (r^-(l+1) + t r^l).
    const double t = std::pow(a, -2 * l - 1) * (-(l + 1) - log_slope) / (log_slope - l);
    const auto between = [&](double s) { return std::pow(s, -l - 1) + t * std::pow(s, l); };
    const double between_slope = -(l + 1) * std::pow(b, -l - 2) + t * l * std::pow(b, l - 1);
    // Inside: S r^-(l+1) + B r^l; potential and displacement are continuous at b.
    const double source = kCoulomb / eps_in * std::pow(e_, l);
    const double g =
        (2 * l + 1) * source * std::pow(b, -l - 2) * eps_in / (between(b) / b * l * eps_in - eps_out * between_slope);
    return r < a ? g * between(r) : g * between(a) * decaying(l, r) / edge;
  }

  double sphere_, exclusion_, e_;
  PoissonBoltzmannOptions o_;
  double kappa_;
};

struct SphereErrors {
  double rms = 0, worst = 0, rms_at_3_A = 0;
};

/// Errors on the grid's points from two steps beyond the sphere to 4 A, with the default solvent and border: of the
/// rms, the largest of the value there, and of the rms between 2.75 and 3.25 A.
SphereErrors sphere_errors(Engine& engine, double e, double spacing, const PoissonBoltzmannOptions& options) {
  constexpr double kSphere = 3;
  const Vec3d centre{0.11, -0.07, 0.05}, way{0.48, 0.6, 0.64};
  const Molecule m = molecule_of({centre, centre + e * way}, {static_cast<float>(kSphere), 0.0F}, {0.0F, 1.0F});
  const Grid map = pb_map(engine, m, pb_lattice(m, spacing, espdiff::kUsualPbPadding_A), options);
  const Kirkwood exact(kSphere, kSphere + options.ion_radius_A, e, options);
  double squares = 0, differences = 0, squares_at_3_A = 0, differences_at_3_A = 0;
  SphereErrors errors;
  for (std::size_t p = 0; p < map.values.size(); ++p) {
    const Vec3d d = point_of(map.lattice, p) - centre;
    const double r = norm(d);
    if (r < kSphere + 2 * spacing || r > kSphere + 4) continue;
    const double wanted = exact.at(r, dot(d, way) / r), difference = static_cast<double>(map.values[p]) - wanted;
    squares += wanted * wanted;
    differences += difference * difference;
    if (std::fabs(r - kSphere - 3) < 0.25) {
      squares_at_3_A += wanted * wanted;
      differences_at_3_A += difference * difference;
    }
    errors.worst = std::max(errors.worst, std::fabs(difference / wanted));
  }
  errors.rms = std::sqrt(differences / squares);
  errors.rms_at_3_A = std::sqrt(differences_at_3_A / squares_at_3_A);
  return errors;
}

/// Prints the errors of three spacings, and the order between the finer two.
void check_orders(const std::string& name, double least_order, const std::function<SphereErrors(double)>& errors) {
  const double coarse = errors(1.0).rms, middle = errors(0.5).rms;
  const SphereErrors fine = errors(0.25);
  const double order = std::log2(middle / fine.rms);
  MESSAGE(name, ": error of the rms at 1, 0.5, 0.25 A ", 100 * coarse, " %, ", 100 * middle, " %, ", 100 * fine.rms,
          " %, worst ", 100 * fine.worst, " %, 3 A outside ", 100 * fine.rms_at_3_A, " %; order ", order);
  CHECK(order > least_order);
  CHECK(middle < coarse);
  CHECK(fine.worst < 0.01);
  CHECK(fine.rms_at_3_A < 0.003);
}

}  // namespace

TEST_SUITE_BEGIN("poisson_boltzmann");

TEST_CASE("a Born ion, with and without salt, converges to the analytic potential") {
  for (const auto& engine : fast_back_ends()) {
    for (const double salt : {0.0, 0.15}) {
      PoissonBoltzmannOptions options;
      options.ionic_strength = salt;
      check_orders("Born ion, " + std::to_string(salt) + " mol/l", 1.0,
                   [&](double h) { return sphere_errors(*engine, 0.0, h, options); });
    }
  }
}

TEST_CASE("a charge off the centre of a sphere, salt outside, converges to Kirkwood's series") {
  for (const auto& engine : fast_back_ends()) {
    const PoissonBoltzmannOptions options;
    check_orders("Kirkwood, 1 of 3 A off", 1.0, [&](double h) { return sphere_errors(*engine, 1.0, h, options); });
  }
}

TEST_CASE("without a dielectric boundary or room for atoms: Debye and Hueckel's potentials") {
  PoissonBoltzmannOptions options;
  options.solute_dielectric = options.solvent_dielectric;
  options.ion_radius_A = 0;
  options.far_boundary = espdiff::FarBoundary::kDebyeHueckel;  // exact here
  const Molecule m =
      molecule_of({{0.1, 0.2, -0.3}, {2.4, -1.1, 0.7}, {-1.7, 0.4, 1.9}}, {0.01F, 0.01F, 0.01F}, {1.0F, -2.0F, 0.7F});
  const double kappa = kappa_of(options);
  for (const auto& engine : fast_back_ends()) {
    double errors[2] = {};
    int at = 0;
    for (const double h : {1.0, 0.5}) {
      const Grid map = pb_map(*engine, m, pb_lattice(m, h, 10), options);
      std::vector<double> ours, exact;
      for (std::size_t p = 0; p < map.values.size(); ++p) {
        double sum = 0, nearest = 1e9;
        for (std::size_t i = 0; i < m.size(); ++i) {
          const double r = norm(point_of(map.lattice, p) - m.positions[i]);
          sum += static_cast<double>(m.charges[i]) * std::exp(-kappa * r) / r;
          nearest = std::min(nearest, r);
        }
        if (nearest < 3) continue;
        ours.push_back(static_cast<double>(map.values[p]));
        exact.push_back(kCoulomb / options.solvent_dielectric * sum);
      }
      errors[at++] = deviation(ours, exact).of_rms;
    }
    MESSAGE("Debye-Hueckel: error of the rms at 1, 0.5 A ", 100 * errors[0], " %, ", 100 * errors[1], " %; order ",
            std::log2(errors[0] / errors[1]));
    CHECK(errors[1] < 0.005);
    CHECK(std::log2(errors[0] / errors[1]) > 1.5);
  }
}

TEST_CASE("a Gaussian dielectric around one charge: the integral of the field") {
  PoissonBoltzmannOptions options;
  options.ionic_strength = 0;
  options.dielectric_boundary = DielectricBoundary::kGaussian;
  constexpr double kRadius = 2;
  const Molecule m = molecule_of({{0.1, -0.2, 0.05}}, {static_cast<float>(kRadius)}, {1.0F});
  const auto exact = [&](double r) {
    // phi(r) = C integral from r on of ds / (eps(s) s^2), beyond 12 A in solvent alone.
    double sum = kCoulomb / (options.solvent_dielectric * 12);
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double s = r + (12 - r) * (i + 0.5) / kSteps, scaled = s / (options.gaussian_sigma * kRadius);
      const double solute = std::exp(-scaled * scaled);
      sum += kCoulomb * (12 - r) / kSteps /
             ((solute * options.solute_dielectric + (1 - solute) * options.solvent_dielectric) * s * s);
    }
    return sum;
  };
  for (const auto& engine : fast_back_ends()) {
    const Grid map = pb_map(*engine, m, pb_lattice(m, 0.25, 10), options);
    std::vector<double> ours, wanted;
    for (std::size_t p = 0; p < map.values.size(); p += 7) {
      const double r = norm(point_of(map.lattice, p) - m.positions[0]);
      if (r < 1 || r > 6) continue;
      ours.push_back(static_cast<double>(map.values[p]));
      wanted.push_back(exact(r));
    }
    CHECK(deviation(ours, wanted).of_rms < 0.01);
  }
}

TEST_CASE("focusing gives the potential of a larger grid") {
  for (const auto& engine : fast_back_ends()) {
    PoissonBoltzmannOptions options;
    options.far_boundary = espdiff::FarBoundary::kDebyeHueckel;
    const Molecule m = molecule_of({{0, 0, 0}, {0, 0, 3}}, {3.0F, 2.0F}, {1.0F, -0.5F});
    const Lattice small = pb_lattice(m, 0.5, 5);
    const Grid large =
        engine->download(engine->resample(pb_on_device(*engine, m, pb_lattice(m, 0.5, 16), options), small));
    const double by_sum = deviation(pb_map(*engine, m, small, options).values, large.values).of_rms;
    options.far_boundary = espdiff::FarBoundary::kFocus;
    const double by_focus = deviation(pb_map(*engine, m, small, options).values, large.values).of_rms;
    CAPTURE(by_sum);
    CAPTURE(by_focus);
    CHECK(by_focus < 0.003);
    CHECK(by_focus < by_sum);
  }
}

TEST_CASE("what each of two charges in a sphere adds to the potential at a point is its term of Kirkwood's series") {
  constexpr double kSphere = 3, kOff = 1.2, kSpacing = 0.25;
  const Vec3d centre{0.11, -0.07, 0.05}, ways[2] = {{0.48, 0.6, 0.64}, {0, -0.8, 0.6}};
  const Molecule m = molecule_of({centre, centre + kOff * ways[0], centre + kOff * ways[1]},
                                 {static_cast<float>(kSphere), 0.0F, 0.0F}, {0.0F, 1.0F, -0.6F});
  const PoissonBoltzmannOptions options;
  const Kirkwood exact(kSphere, kSphere + options.ion_radius_A, kOff, options);
  for (const auto& engine : fast_back_ends()) {
    const auto map = pb_on_device(*engine, m, pb_lattice(m, kSpacing, 10), options);
    const auto mesh = comparison_surface(*engine, molecule_of({centre}, {static_cast<float>(kSphere)}, {0.0F}));
    std::vector<Vec3f> points = engine->download_positions(mesh);
    for (Vec3f& p : points) p = static_cast<Vec3f>(centre + 1.5 * (static_cast<Vec3d>(p) - centre));
    for (const std::size_t v : {std::size_t{0}, points.size() / 2, points.size() - 1}) {
      const auto found = engine->contributions(map, {{{points[v]}, {1.0}}}, {}, {}).front();
      const Vec3d d = static_cast<Vec3d>(points[v]) - centre;
      CHECK(found[0] == 0);
      for (std::size_t i = 0; i < 2; ++i) {
        const double wanted = static_cast<double>(m.charges[i + 1]) * exact.at(norm(d), dot(d, ways[i]) / norm(d));
        CHECK(found[i + 1] == doctest::Approx(wanted).epsilon(0.005));
      }
    }
  }
}

TEST_SUITE_END();
