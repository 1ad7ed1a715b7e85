// display_here.h: whether tests can draw, and how to simulate that they cannot.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "view/display.h"

namespace espdiff_test {

/// Ends the test with a message if drawing is impossible.
inline bool can_draw() {
  const std::string problem = espdiff::display_problem();
  if (!problem.empty()) MESSAGE("SKIPPED: " << problem);
  return problem.empty();
}

/// Sets DISPLAY for one scope.
class DisplayName {
 public:
  explicit DisplayName(const char* name) {
    const char* before = std::getenv("DISPLAY");
    was_set_ = before != nullptr;
    if (was_set_) before_ = before;
    setenv("DISPLAY", name, 1);
  }
  ~DisplayName() {
    if (was_set_)
      setenv("DISPLAY", before_.c_str(), 1);
    else
      unsetenv("DISPLAY");
  }
  DisplayName(const DisplayName&) = delete;
  DisplayName& operator=(const DisplayName&) = delete;

 private:
  bool was_set_ = false;
  std::string before_;
};

}  // namespace espdiff_test
