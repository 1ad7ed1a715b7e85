// short_numbers.h: numbers as reasons and warnings write them.
#pragma once

#include <string>

#include "base/formatted.h"

namespace espdiff {

/// With three significant digits.
inline std::string short_number(double value) { return formatted("%.3g", value); }
inline std::string percent(double fraction) { return short_number(100 * fraction) + " %"; }
inline std::string angstrom(double length) { return short_number(length) + " A"; }

}  // namespace espdiff
