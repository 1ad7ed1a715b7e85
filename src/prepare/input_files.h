// input_files.h: the files that a comparison's settings name.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/input_options.h"

namespace espdiff {

/// Topologies, ligands, charges of another state, and the results that patches are from, for check_outputs().
std::vector<std::string> input_files(const InputOptions& options);

}  // namespace espdiff
