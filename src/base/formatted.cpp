// formatted.cpp: prints in the locale "C", for the calling thread alone.
#include "base/formatted.h"

#include <clocale>
#include <cstdarg>
#include <cstdio>
#if defined(__APPLE__)
#include <xlocale.h>
#endif
#include <locale.h>

namespace espdiff {
namespace {

/// Null where the system has no memory for it; then numbers are as the program's locale says.
locale_t plain_locale() {
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  return plain;
}

/// For the calling thread, until the end of the scope.
class PlainNumbers {
 public:
  PlainNumbers() : before_(uselocale(plain_locale())) {}
  ~PlainNumbers() { uselocale(before_); }
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  locale_t before_;
};

}  // namespace

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
