// whole_runs.h: benchmarks beyond one pair: the matrix of many variants, and potentials by PME and Poisson-Boltzmann.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "stage_timer.h"

namespace espdiff_bench {

struct WholeRun {
  std::string name;  ///< "matrix_19/1tca", "pme_50k/80"
  std::function<void(StageTimer&, espdiff::Engine&)> run;
  bool slow;  ///< takes minutes on a CPU: run once, and with the most threads only
};

/// The benchmarks whose inputs are available.
std::vector<WholeRun> whole_runs();

}  // namespace espdiff_bench
