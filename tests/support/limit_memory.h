// limit_memory.h: whether tests can limit, or measure, the memory of a program.
#pragma once

#include <doctest/doctest.h>

// g++ defines a macro; clang++ answers a question.
#if defined(__SANITIZE_ADDRESS__)
#define ESPDIFF_TEST_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ESPDIFF_TEST_ADDRESS_SANITIZER
#endif
#endif

namespace espdiff_test {

/// Whether a program's memory can be limited (`ulimit -v`) and measured; says why where it cannot.
inline bool can_limit_memory() {
#if defined(ESPDIFF_TEST_ADDRESS_SANITIZER)
  MESSAGE("SKIPPED: the address sanitizer maps more than any limit on memory, and keeps what was freed");
  return false;
#else
  return true;
#endif
}

}  // namespace espdiff_test
