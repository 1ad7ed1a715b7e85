// frames.h: the frames of trajectories as states.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Frames.
void add_frames(nanobind::module_& module);

}  // namespace espdiff::python
