// next_command.cpp: what was typed, with changes, in a shell's words.
#include "cli/next_command.h"

#include <algorithm>

#include "cli/spelling.h"

namespace espdiff::cli {

TypedWords with_options(TypedWords words, const std::vector<NamedOption>& options) {
  for (const NamedOption& option : options) {
    const std::string name = "--" + option.name;
    for (auto word = words.begin(); word != words.end();) {
      if (word->rfind(name + "=", 0) == 0) {
        word = words.erase(word);
      } else if (*word == name) {
        word = words.erase(word);
        if (!option.is_switch && word != words.end()) word = words.erase(word);
      } else {
        ++word;
      }
    }
    words.push_back(name);
    if (!option.is_switch) words.push_back(option.value);
  }
  return words;
}

TypedWords exchanged(TypedWords words, const std::string& a, const std::string& b) {
  const auto first = std::find(words.begin(), words.end(), a), second = std::find(words.begin(), words.end(), b);
  if (first != words.end() && second != words.end() && first != second) std::iter_swap(first, second);
  return words;
}

std::string as_typed(const TypedWords& words) {
  std::string line = "espdiff";
  for (const std::string& word : words) line += " " + shell_quoted(word);
  return line;
}

std::string next_command(const TypedWords& words, const NextCommand& next) {
  return next.before + as_typed(with_options(words, next.options));
}

}  // namespace espdiff::cli
