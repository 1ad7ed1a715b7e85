// shared_range.h: one scale for the pictures of a study.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "plot/automatic_range.h"

namespace espdiff {

/// The largest automatic_limit() of each array of one number a vertex over several surfaces, by the array's name. An
/// array that only some of them have counts there.
/// @param surfaces   VTP files of results
/// @param percentile 50 to 100
/// @throws IoError, FormatError (files that cannot be read), InputError (their potentials have different units)
std::map<std::string, double> shared_limits(const std::vector<std::string>& surfaces,
                                            double percentile = kAutomaticPercentile);

}  // namespace espdiff
