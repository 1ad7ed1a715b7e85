// text.h: what tests look for in texts, and change in them.
#pragma once

#include <doctest/doctest.h>

#include <string>

namespace espdiff_test {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// `text` with the first `what` replaced; the test ends if there is none.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  REQUIRE(contains(text, what));
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace espdiff_test
