// poisson_boltzmann_inputs.h: what the tests of the Poisson-Boltzmann potential share: charges, grids, comparisons.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "cuda/surface/back_ends.h"
#include "engine/engine.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff_test {

using espdiff::Grid;
using espdiff::Lattice;
using espdiff::Molecule;
using espdiff::PoissonBoltzmannOptions;
using espdiff::PoissonBoltzmannReport;

/// back_ends() but for an emulated GPU, on which grids of these sizes would take hours; "back ends agree" runs there.
inline std::vector<std::unique_ptr<Engine>> fast_back_ends(int n_threads = 0) {
  std::vector<std::unique_ptr<Engine>> engines;
  for (auto& engine : back_ends(n_threads)) {
    if (engine->description().find("PTX on the CPU") == std::string::npos) {
      engines.push_back(std::move(engine));
    } else {
      MESSAGE("SKIPPED: cuda: the emulator would take hours over this grid");
    }
  }
  return engines;
}

inline Molecule molecule_of(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                            const std::vector<float>& charges) {
  Molecule molecule;
  molecule.positions = positions;
  molecule.radii = radii;
  molecule.charges = charges;
  return molecule;
}

inline Lattice pb_lattice(const Molecule& m, double spacing, double padding) {
  return espdiff::poisson_boltzmann_lattice(m.positions, m.radii, spacing, padding);
}

inline espdiff::GridPtr pb_on_device(Engine& engine, const Molecule& m, const Lattice& lattice,
                                     const PoissonBoltzmannOptions& options, PoissonBoltzmannReport* report = nullptr,
                                     const espdiff::GridPtr& start = nullptr,
                                     const espdiff::RigidTransform& to_map = {}) {
  return engine.poisson_boltzmann(m.positions, m.radii, m.charges, lattice, options, to_map, start, {}, report);
}

inline Grid pb_map(Engine& engine, const Molecule& m, const Lattice& lattice, const PoissonBoltzmannOptions& options,
                   PoissonBoltzmannReport* report = nullptr) {
  return engine.download(pb_on_device(engine, m, lattice, options, report));
}

inline Vec3d point_of(const Lattice& lattice, std::size_t p) {
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  return lattice.origin + static_cast<double>(p % nx) * lattice.step[0] +
         static_cast<double>(p / nx % ny) * lattice.step[1] + static_cast<double>(p / (nx * ny)) * lattice.step[2];
}

/// How two sets of potentials differ.
struct Deviation {
  double of_rms = 0, correlation = 0, mean_absolute = 0;
};
template <typename A, typename B>
Deviation deviation(const A& a, const B& b) {
  double difference = 0, squares = 0, n = 0, sums[5] = {}, absolute = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    difference += (x - y) * (x - y);
    squares += y * y;
    absolute += std::fabs(x - y);
    sums[0] += x;
    sums[1] += y;
    sums[2] += x * x;
    sums[3] += y * y;
    sums[4] += x * y;
    n += 1;
  }
  const double covariance = sums[4] / n - sums[0] / n * sums[1] / n;
  const double variances = (sums[2] / n - sums[0] / n * sums[0] / n) * (sums[3] / n - sums[1] / n * sums[1] / n);
  return {std::sqrt(difference / squares), covariance / std::sqrt(variances), absolute / n};
}

/// The surface that potentials are compared on, with the mapping's default parameters.
inline espdiff::MeshPtr comparison_surface(Engine& engine, const Molecule& m) {
  const auto atoms = engine.upload_atoms(m.positions, m.radii, std::vector<std::int32_t>(m.size(), 0));
  return engine.project(engine.isosurface(engine.density(atoms, 1.0), 0.5F), atoms, 0.5F, 1.0);
}

}  // namespace espdiff_test
