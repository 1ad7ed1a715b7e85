// command_line.h: the command line in this process.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the function command_line().
void add_command_line(nanobind::module_& module);

}  // namespace espdiff::python
