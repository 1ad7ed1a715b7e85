// joined_words.h: a list of words as a sentence has it.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// "a, b or c"
inline std::string joined_words(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return list;
}

}  // namespace espdiff
