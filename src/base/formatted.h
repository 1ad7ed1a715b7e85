// formatted.h: numbers as text, with a decimal point whatever locale the program around us has chosen.
#pragma once

#include <string>

namespace espdiff {

/// As std::snprintf's, of any length. Programs with a window, such as notebooks with Qt, choose the user's locale, in
/// which snprintf writes "0,15".
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// With six significant digits, for messages.
inline std::string formatted(double value) { return formatted("%g", value); }

}  // namespace espdiff
