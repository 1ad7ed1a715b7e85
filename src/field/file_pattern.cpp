// file_pattern.cpp: finds and fills the places of a pattern.
#include "field/file_pattern.h"

#include <array>
#include <optional>
#include <utility>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr std::array<const char*, 3> kWords = {"{label}", "{group}", "{replicate}"};

/// Where `%d` or `%0Nd` stands.
struct NumberPlace {
  std::size_t begin = 0, end = 0, width = 0;
};

std::optional<NumberPlace> number_place(const std::string& pattern, std::size_t from) {
  for (std::size_t i = pattern.find('%', from); i != std::string::npos; i = pattern.find('%', i + 1)) {
    const std::size_t letter = pattern.find_first_not_of("0123456789", i + 1);
    if (letter == std::string::npos || pattern[letter] != 'd') continue;
    const std::string digits = pattern.substr(i + 1, letter - i - 1);
    if (!digits.empty() && (digits.size() != 2 || digits[0] != '0')) continue;
    return NumberPlace{i, letter + 1, digits.empty() ? 0 : static_cast<std::size_t>(digits[1] - '0')};
  }
  return std::nullopt;
}

[[noreturn]] void refuse_place(const std::string& what, const std::string& place, const std::string& owner) {
  throw InputError(what + " has the place " + place + ", which is " + owner + "; this state is none");
}

}  // namespace

std::size_t count_frame_places(const std::string& pattern) {
  std::size_t n = 0, from = 0;
  while (const auto place = number_place(pattern, from)) {
    from = place->end;
    ++n;
  }
  return n;
}

bool is_pattern(const std::string& pattern) {
  for (const char* const word : kWords) {
    if (pattern.find(word) != std::string::npos) return true;
  }
  return count_frame_places(pattern) > 0;
}

std::string fill_pattern(const std::string& pattern, const FieldInput& state, const std::string& what) {
  std::string path = pattern;
  if (const auto place = number_place(path, 0)) {
    if (state.frame < 0)
      refuse_place(what, path.substr(place->begin, place->end - place->begin), "the number of a frame");
    std::string number = std::to_string(state.frame);
    number.insert(0, place->width > number.size() ? place->width - number.size() : 0, '0');
    path.replace(place->begin, place->end - place->begin, number);
  }
  const std::array<const std::string*, kWords.size()> values = {&state.label, &state.group, &state.replicate};
  for (std::size_t k = 0; k < kWords.size(); ++k) {
    const std::string word = kWords[k];
    const std::size_t at = path.find(word);
    if (at == std::string::npos) continue;
    if (values[k]->empty())
      refuse_place(what, word, k == 2 ? "the name of a frame's replicate" : "that of a variant in a matrix");
    path.replace(at, word.size(), *values[k]);
  }
  return path;
}

}  // namespace espdiff
