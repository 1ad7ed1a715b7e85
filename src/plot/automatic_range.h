// automatic_range.h: the end of a colour scale when none is given: one rule for VMD, the viewer and pictures.
#pragma once

#include <vector>

namespace espdiff {

/// Share of the values, in per cent, that an automatic scale covers. Differences of potentials have long tails: the
/// last few per cent of the points, in crevices and off the target, would otherwise leave the rest of the surface grey.
inline constexpr double kAutomaticPercentile = 90;

/// The smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10 times a power of ten that is not below `value`; 1 for a value of
/// 0.
double round_up_nicely(double value);

/// The magnitude that `percentile` per cent of the finite values do not exceed, rounded up nicely; 1 if there are none.
/// Where more than half of them are below a thousandth of the greatest, such as aromatic rings' away from rings, only
/// the others count.
/// @param percentile 50 to 100
double automatic_limit(const std::vector<float>& values, double percentile = kAutomaticPercentile);

}  // namespace espdiff
