// whole_runs.h: work that is not a stage of one pair: the matrix of many variants, and potentials by PME.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/handles.h"
#include "stage_timer.h"

namespace espdiff_bench {

struct WholeRun {
  std::string name;  ///< "matrix_19/1tca", "pme_50k/80"
  std::function<void(StageTimer&, espdiff::Engine&)> run;
  bool slow;  ///< minutes on a CPU: run once, and with the most threads only
};

/// Those whose inputs are there.
std::vector<WholeRun> whole_runs();

}  // namespace espdiff_bench
