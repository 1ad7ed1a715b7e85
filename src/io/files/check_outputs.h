// check_outputs.h: makes sure, before any work, that a run's outputs replace neither its inputs nor each other.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// Checks the files of one run, before it computes: one output may neither be an input nor another output, by whatever
/// name (links of either kind, ways through folders), and all names are UTF-8, since results name their files in JSON.
/// Empty names are passed over. Then removes what killed runs left beside the outputs (remove_leftovers()).
/// @param overwrite whether outputs may replace files that are there; devices are no such files
/// @throws InputError that names both; a name that is not UTF-8; a file that is there, with `overwrite` as the next
///         command
void check_outputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                   bool overwrite = true);

}  // namespace espdiff
