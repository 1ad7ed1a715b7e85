// map_pattern.cpp: finds and fills the places of a pattern.
#include "ensemble/map_pattern.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr const char* kReplicate = "{replicate}";

/// Where `%d` or `%0Nd` stands.
struct Place {
  std::size_t begin = 0, end = 0, width = 0;
};

std::optional<Place> number_place(const std::string& pattern, std::size_t from) {
  for (std::size_t i = pattern.find('%', from); i != std::string::npos; i = pattern.find('%', i + 1)) {
    const std::size_t letter = pattern.find_first_not_of("0123456789", i + 1);
    if (letter == std::string::npos || pattern[letter] != 'd') continue;
    const std::string digits = pattern.substr(i + 1, letter - i - 1);
    if (!digits.empty() && (digits.size() != 2 || digits[0] != '0')) continue;
    return Place{i, letter + 1, digits.empty() ? 0 : static_cast<std::size_t>(digits[1] - '0')};
  }
  return std::nullopt;
}

}  // namespace

void check_map_pattern(const std::string& pattern) {
  const auto place = number_place(pattern, 0);
  if (!place || number_place(pattern, place->end))
    throw InputError(option("maps") + ": '" + pattern +
                     "' does not have one place for the frame's number, such as %d or %03d");
}

std::string map_file(const std::string& pattern, const std::string& replicate, int frame) {
  const Place place = number_place(pattern, 0).value();
  std::string number = std::to_string(frame);
  number.insert(0, place.width > number.size() ? place.width - number.size() : 0, '0');
  std::string path = pattern;
  path.replace(place.begin, place.end - place.begin, number);
  const std::string name = kReplicate;
  const std::size_t at = path.find(name);
  if (at != std::string::npos) path.replace(at, name.size(), replicate);
  return path;
}

}  // namespace espdiff
