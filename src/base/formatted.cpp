// formatted.cpp: prints in the locale "C", for the calling thread alone.
#include "base/formatted.h"

#include <cstdarg>
#include <cstdio>

#include "system/plain_numbers.h"

namespace espdiff {

std::string formatted(const char* format, ...) {
  const PlainNumbers here;
  char text[256];
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  std::string result;
  if (length >= 0 && length < static_cast<int>(sizeof text)) {
    result.assign(text, static_cast<std::size_t>(length));
  } else if (length > 0) {
    result.resize(static_cast<std::size_t>(length) + 1);
    std::vsnprintf(result.data(), result.size(), format, again);
    result.pop_back();
  }
  va_end(again);
  return result;
}

}  // namespace espdiff
