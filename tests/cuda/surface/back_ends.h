// back_ends.h: the engines that the engine's tests run on.
#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/select_engine.h"

namespace espdiff_test {

using espdiff::Engine;

/// One engine for each back end that can run here; prints once per program which cannot, and why.
/// @param n_threads of the CPU back end; 0 uses all
inline std::vector<std::unique_ptr<Engine>> back_ends(int n_threads = 0) {
  std::vector<std::unique_ptr<Engine>> engines;
  engines.push_back(espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads));
  const espdiff::BackEndStatus cuda = espdiff::cuda_status();
  static bool announced = false;
  if (cuda.available) {
    engines.push_back(espdiff::select_engine(espdiff::DeviceChoice::kCuda, 0));
  } else if (!announced) {
    announced = true;
    MESSAGE("SKIPPED: cuda: ", cuda.description.plain());
  }
  return engines;
}

inline espdiff::AtomsPtr upload(Engine& engine, const AtomSet& atoms) {
  return engine.upload_atoms(atoms.positions, atoms.widths, atoms.residues);
}

}  // namespace espdiff_test
