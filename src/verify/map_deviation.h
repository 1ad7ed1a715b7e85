// map_deviation.h: potentials at vertices against the map they were read from.
#pragma once

#include <string>
#include <vector>

#include "base/types.h"
#include "verify/result_record.h"

namespace espdiff {

/// Interpolates the map linearly at the points.
/// @param[out] largest deviation of the potentials  @param[out] scale their largest magnitude
/// @returns why it cannot be done; empty if it was
/// @throws as read_grid(), InputError (the file has changed since)
std::string map_deviation(const VerifiedInput& input, const std::string& unit, const std::vector<Vec3d>& points,
                          const std::vector<double>& potentials, double& largest, double& scale);

}  // namespace espdiff
