// not_a_number.h: the number that stands for no value.
#pragma once

#include <limits>

namespace espdiff {

/// No value; written as an empty cell (CSV) or null (JSON).
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace espdiff
