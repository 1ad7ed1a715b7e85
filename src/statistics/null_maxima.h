// null_maxima.h: p-values from the largest values under the null, for the tests over a surface.
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/surface/surface_test.h"

namespace espdiff {

struct WelchTest;

/// Area-weighted mean magnitude; NaN does not count.
double mean_abs(const std::vector<double>& values, const MeshGraph& graph);
/// The largest magnitude; NaN does not count.
double largest_magnitude(const std::vector<double>& values);
/// The share of the sorted magnitudes that are at least |value|, up to rounding.
double share_at_least(const std::vector<double>& sorted, double value);
/// share_at_least() of each value whose `tested` is a number; NaN elsewhere.
std::vector<double> shares_at_least(std::vector<double> maxima, const std::vector<double>& values,
                                    const std::vector<double>& tested);
/// Adds a place with its interval.
void add_place(PlaceTests& tests, const WelchTest& test, double confidence);
/// Sets a place's difference; its interval keeps its width.
void move_to(PlaceTests& tests, std::size_t place, double difference);

}  // namespace espdiff
