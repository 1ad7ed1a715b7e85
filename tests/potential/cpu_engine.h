// cpu_engine.h: the engine of the tests of potentials, and whether it can compute them here.
#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "base/error.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "potential/potential_series.h"

namespace espdiff_test {

/// @param n_threads 0 for all
inline std::unique_ptr<espdiff::Engine> cpu(int n_threads = 0) {
  return espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
}

/// Whether potentials can be computed; says why where they cannot.
inline bool can_run() {
  try {
    espdiff::potential_map(*cpu(), make_side(1, 0).molecule, {}, {});
    return true;
  } catch (const espdiff::DeviceError& error) {
    MESSAGE("SKIPPED: ", std::string(error.what()));
    return false;
  }
}

}  // namespace espdiff_test
