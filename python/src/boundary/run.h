// run.h: long computations on a thread of their own, so that Python continues and Ctrl-C ends them.
#pragma once

#include <nanobind/nanobind.h>

#include <functional>

#include "base/progress.h"

namespace espdiff::python {

/// Runs `work` on a new thread and waits for it without the interpreter's lock. The waiting thread looks for signals
/// and tells the listener of the progress 50 times a second. OpenMP's threads end with the new thread, so that a
/// process that has computed can fork.
/// @param listener called as listener(stage, fraction); None for none
/// @throws what `work` throws; KeyboardInterrupt or what the listener raises, when the work has ended
void run(const nanobind::object& listener, const std::function<void(const Progress&)>& work);

}  // namespace espdiff::python
