// short_numbers.h: numbers as reasons and warnings write them.
#pragma once

#include <cstdio>
#include <string>

namespace espdiff {

/// With three significant digits.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}
inline std::string percent(double fraction) { return short_number(100 * fraction) + " %"; }
inline std::string angstrom(double length) { return short_number(length) + " A"; }

}  // namespace espdiff
