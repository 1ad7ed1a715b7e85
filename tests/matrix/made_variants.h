// made_variants.h: a few made molecules as the variants of a matrix.
#pragma once

#include <memory>

#include "compare/made_side.h"
#include "engine/select_engine.h"
#include "io/files/sha256.h"
#include "matrix/matrix_run.h"

namespace espdiff_test {

inline std::unique_ptr<espdiff::Engine> cpu_engine(int n_threads = 2) {
  return espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
}

/// The same molecule bent more and more, in groups of two.
inline std::vector<espdiff::Variant> made_variants(std::size_t n, std::size_t n_atoms = 60) {
  std::vector<espdiff::Variant> variants;
  for (std::size_t i = 0; i < n; ++i) {
    Side side = make_side(i + 1, 0.1, n_atoms);
    for (Vec3d& p : side.molecule.positions) p.z += 0.01 * static_cast<double>(i * i) * p.x;
    side.map = potential_map(side.molecule, 1.5);
    espdiff::Variant variant;
    variant.label = "v" + std::to_string(i);
    variant.group = std::string(1, static_cast<char>('A' + i / 2));
    variant.inputs = {{"structure", variant.label + ".pqr", espdiff::sha256_of(variant.label)}};
    variant.molecule = side.molecule;
    variant.map = side.map;
    variants.push_back(std::move(variant));
  }
  return variants;
}

inline CompareOptions matrix_options() {
  CompareOptions options = quick_options();
  options.surface.grid_spacing_A = 1.5;
  options.regularize.max_iterations = 20;
  options.deform.max_iterations = 40;
  return options;
}

}  // namespace espdiff_test
