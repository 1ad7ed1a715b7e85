// short_numbers.h: numbers as reasons and warnings write them.
#pragma once

#include <string>

#include "base/formatted.h"

namespace espdiff {

/// With three significant digits.
inline std::string short_number(double value) { return formatted("%.3g", value); }
inline std::string percent(double fraction) { return short_number(100 * fraction) + " %"; }
inline std::string angstrom(double length) { return short_number(length) + " A"; }

/// With `decimals`, or as many more as tell the value from a limit that it does not equal.
inline std::string number_beside(double value, double limit, int decimals) {
  constexpr int kMostDecimals = 12;
  std::string text = formatted("%.*f", decimals, value);
  while (value != limit && decimals < kMostDecimals && text == formatted("%.*f", decimals, limit))
    text = formatted("%.*f", ++decimals, value);
  return text;
}

}  // namespace espdiff
