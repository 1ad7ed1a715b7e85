// plan_difference.h: how two plans of a run differ, in words.
#pragma once

#include <initializer_list>
#include <string>

namespace espdiff {

/// "the version is 1 there and 2 here"; empty where they agree.
inline std::string differ(const std::string& what, const std::string& there, const std::string& here) {
  if (there == here) return "";
  const auto shown = [](const std::string& text) { return text.empty() ? std::string("none") : text; };
  return what + " is " + shown(there) + " there and " + shown(here) + " here";
}

/// The first nonempty entry of a list; empty if there is none.
inline std::string first_of(std::initializer_list<std::string> differences) {
  for (const std::string& difference : differences) {
    if (!difference.empty()) return difference;
  }
  return "";
}

}  // namespace espdiff
