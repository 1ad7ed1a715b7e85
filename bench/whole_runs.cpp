// whole_runs.cpp: makes the variants and charges, and times the matrix, PME and Poisson-Boltzmann on them.
#include "whole_runs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/progress.h"
#include "engine/engine.h"
#include "engine/poisson_boltzmann.h"
#include "io/structures/structure_file.h"
#include "matrix/matrix.h"
#include "options/options.h"
#include "random_charges.h"
#include "real_pairs.h"
#include "synthetic_protein.h"

namespace espdiff_bench {
namespace {

/// Compares each of n copies of a molecule, each with its own smooth displacement, with each other, in both directions,
/// by `deform`.
void matrix(StageTimer& timer, espdiff::Engine& engine, const std::string& file, int n) {
  constexpr double kDisplacement_A = 0.5;
  const espdiff::Molecule molecule = espdiff::read_structure(file);
  std::vector<espdiff::Variant> variants;
  for (int i = 0; i < n; ++i) {
    espdiff::Variant variant;
    variant.label = "copy " + std::to_string(i);
    variant.molecule = displaced_smoothly(molecule, kDisplacement_A, static_cast<std::uint64_t>(i) + 2);
    variant.map = smooth_map(variant.molecule);
    variants.push_back(std::move(variant));
  }
  espdiff::CompareOptions options;
  options.method = espdiff::Method::kDeform;
  std::size_t n_pairs = 0, n_trustworthy = 0;
  timer.time(engine, [&] {
    n_pairs = n_trustworthy = 0;
    espdiff::compute_pairs(
        engine, variants, options, espdiff::matrix_pairs(variants.size()), false,
        [&](const espdiff::MatrixCell& cell) {
          ++n_pairs;
          n_trustworthy += cell.trustworthy ? 1 : 0;
        },
        espdiff::Progress{});
  });
  timer.counters["pairs"] = static_cast<double>(n_pairs);
  timer.counters["trustworthy"] = static_cast<double>(n_trustworthy);
  timer.counters["atoms"] = static_cast<double>(molecule.size());
}

/// From charges on the host to the map on the device, in PMEPot's mode.
void pme(StageTimer& timer, espdiff::Engine& engine, std::size_t n_atoms, double edge_A, int n_points) {
  const RandomCharges of = random_charges(n_atoms, edge_A);
  espdiff::PmeOptions options;
  options.order = 4;
  options.compatible = true;
  options.size = {n_points, n_points, n_points};
  timer.time(engine, [&] { engine.pme_potential(of.positions, of.charges, of.cell, options, {}, {}); });
  timer.counters["atoms"] = static_cast<double>(n_atoms);
}

/// A map's samples by B-splines at the n^3 points of a lattice that is not its own.
void pme_samples(StageTimer& timer, espdiff::Engine& engine, int order, int n) {
  constexpr double kEdge_A = 80;
  const RandomCharges of = random_charges(50000, kEdge_A);
  espdiff::PmeOptions options;
  options.order = order;
  options.smooth_samples = true;
  options.size = {80, 80, 80};
  const espdiff::GridPtr map = engine.pme_potential(of.positions, of.charges, of.cell, options, {}, {});
  espdiff::Lattice lattice;
  lattice.size = {n, n, n};
  for (int axis = 0; axis < 3; ++axis) lattice.step[static_cast<std::size_t>(axis)][axis] = kEdge_A / n;
  espdiff::GridPtr samples;
  timer.time(engine, [&] { samples = engine.resample(map, lattice); });
  timer.counters["samples"] = static_cast<double>(lattice.n_points());
  double sum = 0;
  for (const float value : engine.download(samples).values) sum += std::fabs(value);
  timer.counters["mean_magnitude"] = sum / static_cast<double>(lattice.n_points());
}

/// A cube of n^3 points that leaves 12 A around a molecule, by the default options but for a wider grid.
void poisson_boltzmann(StageTimer& timer, espdiff::Engine& engine, const std::string& file, int n) {
  constexpr double kPadding_A = 12;
  const espdiff::Molecule m = espdiff::read_structure(file);
  double spacing = 0.1;
  espdiff::Lattice lattice;
  do {
    spacing *= 1.01;
    lattice = espdiff::poisson_boltzmann_lattice(m.positions, m.radii, spacing, kPadding_A);
  } while (*std::max_element(lattice.size.begin(), lattice.size.end()) > n);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.origin[static_cast<int>(axis)] -= 0.5 * spacing * (n - lattice.size[axis]);
    lattice.size[axis] = n;
  }
  espdiff::PoissonBoltzmannReport report;
  espdiff::PoissonBoltzmannOptions options;
  options.far_boundary = espdiff::FarBoundary::kDebyeHueckel;
  timer.time(engine, [&] {
    engine.poisson_boltzmann(m.positions, m.radii, m.charges, lattice, options, {}, nullptr, {}, &report);
  });
  timer.counters["spacing_A"] = spacing;
  timer.counters["cycles"] = report.cycles;
  timer.counters["residual"] = report.relative_residual;
}

}  // namespace

std::vector<WholeRun> whole_runs() {
  std::vector<WholeRun> all{
      {"pme_50k/80", [](StageTimer& t, espdiff::Engine& e) { pme(t, e, 50000, 80, 80); }, false},
      {"pme_1m/216", [](StageTimer& t, espdiff::Engine& e) { pme(t, e, 1000000, 216, 216); }, false},
      {"pme_samples_1m/order_4", [](StageTimer& t, espdiff::Engine& e) { pme_samples(t, e, 4, 100); }, false},
      {"pme_samples_1m/order_6", [](StageTimer& t, espdiff::Engine& e) { pme_samples(t, e, 6, 100); }, false},
      {"pme_samples_1m/order_8", [](StageTimer& t, espdiff::Engine& e) { pme_samples(t, e, 8, 100); }, false},
  };
  const std::string lysozyme = data_folder() + "/pair_t4l_maps/3lzm.pqr";
  if (std::filesystem::exists(lysozyme)) {
    all.push_back(
        {"pb_97/3lzm", [=](StageTimer& t, espdiff::Engine& e) { poisson_boltzmann(t, e, lysozyme, 97); }, false});
    all.push_back(
        {"pb_257/3lzm", [=](StageTimer& t, espdiff::Engine& e) { poisson_boltzmann(t, e, lysozyme, 257); }, true});
  }
  const std::string file = data_folder() + "/ref_apbs/1tca.pqr";
  if (std::filesystem::exists(file))
    all.push_back({"matrix_19/1tca", [=](StageTimer& t, espdiff::Engine& e) { matrix(t, e, file, 19); }, true});
  return all;
}

}  // namespace espdiff_bench
