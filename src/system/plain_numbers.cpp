// plain_numbers.cpp: a thread's locale, as POSIX 2008 has it.
#include "system/plain_numbers.h"

#include <clocale>
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

}  // namespace

PlainNumbers::PlainNumbers() : before_(uselocale(plain_locale())) {}
PlainNumbers::~PlainNumbers() { uselocale(static_cast<locale_t>(before_)); }

}  // namespace espdiff
