// false_discovery.h: control of the false discovery rate.
#pragma once

#include <vector>

namespace espdiff {

/// p-values adjusted for the false discovery rate (Benjamini & Hochberg 1995, J. R. Stat. Soc. B 57:289): rejecting all
/// whose adjusted p is at most q keeps the expected share of false discoveries at or below q, for independent or
/// positively dependent tests.
/// @param p NaN: not tested, which stays NaN and does not count
std::vector<double> adjust_for_false_discovery(const std::vector<double>& p);

}  // namespace espdiff
