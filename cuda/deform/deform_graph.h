// deform_graph.h: the iterations of deform() on a GPU, as a graph that is launched repeatedly.
#pragma once

#include <string>

#include "cuda/deform/deform_iteration.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The same bits: rounds of kCheckInterval iterations, each with a check, are recorded once as a CUDA graph. The check
/// decides on the device; kernels after convergence do nothing, so the host waits only once per graph.
void iterate_in_graphs(DeformState& state, const DeformOptions& options, const std::string& stage,
                       const Progress& progress, DeformReport& report);

}  // namespace espdiff::ESPDIFF_BACKEND
