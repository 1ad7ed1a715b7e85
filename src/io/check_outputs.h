// check_outputs.h: makes sure, before any work, that a run's outputs replace neither its inputs nor each other.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Whether two names mean one file: the same device and inode where both exist (links of either kind), the same path
/// with links followed where they do not.
bool is_same_file(const std::string& a, const std::string& b);

/// Checks the files of one run; empty names are passed over.
/// @throws InputError that names both, when an output is an input, or two outputs are one file
void check_outputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

}  // namespace espdiff
