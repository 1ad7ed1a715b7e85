// ewald_oracle.h: charges in cells of several shapes, and the direct Ewald sum over them as a reference.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/potential_stage.h"
#include "support/random.h"

namespace espdiff_test {

using espdiff::PmeCell;
using espdiff::PmeOptions;

/// C of Engine::pme_potential at 300 K.
inline constexpr double kCoulombInKt = 332.0636 / (300 * 0.001987191);

struct Charges {
  std::vector<Vec3d> positions;
  std::vector<float> charges;
};

struct NamedCell {
  std::string name;
  PmeCell cell;
};

/// Edges of a cell from lengths and angles (degrees): a along x, b in the x-y plane.
inline PmeCell cell_of(Vec3d lengths, Vec3d angles, Vec3d centre) {
  const double alpha = angles.x * kPi / 180, beta = angles.y * kPi / 180, gamma = angles.z * kPi / 180;
  const double cx = std::cos(beta), cy = (std::cos(alpha) - cx * std::cos(gamma)) / std::sin(gamma);
  PmeCell cell;
  cell.centre = centre;
  cell.edges = {Vec3d{lengths.x, 0, 0}, lengths.y * Vec3d{std::cos(gamma), std::sin(gamma), 0},
                lengths.z * Vec3d{cx, cy, std::sqrt(1 - cx * cx - cy * cy)}};
  return cell;
}

/// A cube, a skewed cell and a truncated octahedron, with edges that are not whole numbers.
inline std::vector<NamedCell> cells() {
  constexpr double kOctahedron = 109.4712206;
  return {{"cubic", cell_of({31.7, 31.7, 31.7}, {90, 90, 90}, {3, -2, 7})},
          {"skewed", cell_of({29.3, 34.1, 38.6}, {72, 81, 64}, {-11.5, 4, 0.25})},
          {"truncated octahedron",
           cell_of({34.6, 34.6, 34.6}, {kOctahedron, kOctahedron, kOctahedron}, {20.1, 20.2, 20.3})}};
}

/// Charges anywhere in the cell; every other one is shifted out by one cell.
inline Charges random_charges(const PmeCell& cell, std::size_t n, std::uint64_t seed, bool neutral = false) {
  Random random(seed);
  Charges result;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3d p = cell.centre;
    for (const Vec3d& edge : cell.edges) p += random.uniform(-0.5, 0.5) * edge;
    if (i % 2 == 1) p += cell.edges[i % 3];
    result.positions.push_back(p);
    result.charges.push_back(static_cast<float>(random.uniform(-1, 1)));
    sum += static_cast<double>(result.charges.back());
  }
  if (neutral) result.charges.back() -= static_cast<float>(sum);
  return result;
}

/// The number of points along each edge for steps of about `resolution` A.
inline std::array<int, 3> sizes_of(const PmeCell& cell, double resolution) {
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = static_cast<int>(std::ceil(norm(cell.edges[axis]) / resolution));
  return size;
}

/// The sum over all significant modes at the given points; in double precision.
inline std::vector<double> direct_ewald(const Charges& atoms, const PmeCell& cell, double beta,
                                        const std::vector<Vec3d>& points) {
  const auto& e = cell.edges;
  const double volume = dot(e[0], cross(e[1], e[2]));
  const Vec3d reciprocal[3] = {(1 / volume) * cross(e[1], e[2]), (1 / volume) * cross(e[2], e[0]),
                               (1 / volume) * cross(e[0], e[1])};
  const double longest = 6.5 * beta / kPi;  // there the Gaussian is below 1e-18
  std::vector<double> values(points.size(), 0.0);
  int reach[3];
  for (int axis = 0; axis < 3; ++axis)
    reach[axis] = static_cast<int>(std::ceil(longest * norm(e[static_cast<std::size_t>(axis)])));
  for (int i = -reach[0]; i <= reach[0]; ++i) {
    for (int j = -reach[1]; j <= reach[1]; ++j) {
      for (int k = 0; k <= reach[2]; ++k) {  // the other half is the complex conjugate
        const Vec3d m = static_cast<double>(i) * reciprocal[0] + static_cast<double>(j) * reciprocal[1] +
                        static_cast<double>(k) * reciprocal[2];
        const double square = dot(m, m);
        const bool is_lower_half = k == 0 && (j < 0 || (j == 0 && i <= 0));
        if (square > longest * longest || is_lower_half) continue;
        double real = 0, imaginary = 0;
        for (std::size_t a = 0; a < atoms.positions.size(); ++a) {
          const double phase = 2 * kPi * dot(m, atoms.positions[a]), q = static_cast<double>(atoms.charges[a]);
          real += q * std::cos(phase);
          imaginary += q * std::sin(phase);
        }
        const double factor =
            2 * kCoulombInKt * std::exp(-kPi * kPi * square / (beta * beta)) / (kPi * volume * square);
        for (std::size_t p = 0; p < points.size(); ++p) {
          const double phase = 2 * kPi * dot(m, points[p]);
          values[p] += factor * (real * std::cos(phase) + imaginary * std::sin(phase));
        }
      }
    }
  }
  return values;
}

/// sqrt(sum (a - b)^2 / sum b^2).
inline double relative_rms(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    square += b[i] * b[i];
  }
  return std::sqrt(difference / square);
}

/// The largest |a - b| over the largest |b|.
inline double relative_max(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    most = std::max(most, std::fabs(static_cast<double>(b[i])));
  }
  return difference / most;
}

inline espdiff::Grid pme_map(Engine& engine, const Charges& atoms, const PmeCell& cell, const PmeOptions& options) {
  return engine.download(engine.pme_potential(atoms.positions, atoms.charges, cell, options, {}, {}));
}

/// Relative rms error of a map against the direct sum, at some of its points.
inline double pme_error(Engine& engine, const Charges& atoms, const PmeCell& cell, const PmeOptions& options,
                        std::size_t n_points = 150) {
  const espdiff::Grid map = pme_map(engine, atoms, cell, options);
  Random random(999);
  std::vector<Vec3d> points;
  std::vector<double> values;
  for (std::size_t i = 0; i < n_points; ++i) {
    const std::size_t p = random.below(map.values.size());
    points.push_back(lattice_point(map.lattice, p));
    values.push_back(static_cast<double>(map.values[p]));
  }
  return relative_rms(values, direct_ewald(atoms, cell, options.ewald_factor, points));
}

inline bool can_run(Engine& engine) {
  try {
    engine.pme_potential({{1, 2, 3}}, {1.0F}, cells()[0].cell, {{8, 8, 8}}, {}, {});
    return true;
  } catch (const espdiff::DeviceError& error) {
    MESSAGE("SKIPPED: ", engine.back_end(), ": ", std::string(error.what()));
    return false;
  }
}

/// Back ends whose Fourier transform library is available.
inline std::vector<std::unique_ptr<Engine>> engines_with_fourier(int n_threads = 0) {
  std::vector<std::unique_ptr<Engine>> engines = back_ends(n_threads);
  engines.erase(std::remove_if(engines.begin(), engines.end(), [](const auto& engine) { return !can_run(*engine); }),
                engines.end());
  return engines;
}

inline PmeOptions options_for(const PmeCell& cell, double resolution, int order = 6) {
  PmeOptions options;
  options.size = sizes_of(cell, resolution);
  options.order = order;
  return options;
}

inline PmeOptions in_double(PmeOptions options) {
  options.precision = espdiff::Precision::kDouble;
  return options;
}

}  // namespace espdiff_test
