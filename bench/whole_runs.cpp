// whole_runs.cpp: makes the variants and charges, and times the matrix and PME on them.
#include "whole_runs.h"

#include <algorithm>
#include <filesystem>

#include "base/progress.h"
#include "engine/engine.h"
#include "io/structures/read_structure.h"
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

}  // namespace

std::vector<WholeRun> whole_runs() {
  std::vector<WholeRun> all{
      {"pme_50k/80", [](StageTimer& t, espdiff::Engine& e) { pme(t, e, 50000, 80, 80); }, false},
      {"pme_1m/216", [](StageTimer& t, espdiff::Engine& e) { pme(t, e, 1000000, 216, 216); }, false},
  };
  const std::string file = data_folder() + "/ref_apbs/1tca.pqr";
  if (std::filesystem::exists(file))
    all.push_back({"matrix_19/1tca", [=](StageTimer& t, espdiff::Engine& e) { matrix(t, e, file, 19); }, true});
  return all;
}

}  // namespace espdiff_bench
