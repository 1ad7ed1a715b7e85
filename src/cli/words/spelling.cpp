// spelling.cpp: how the command line writes the options that messages name.
#include "cli/words/spelling.h"

namespace espdiff::cli {

std::string shell_quoted(const std::string& word) {
  const bool is_plain = !word.empty() && word.find_first_of(" ()*;&|<>?[]$\"\\!'`#~\t\n") == std::string::npos;
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string spelled_option(const NamedOption& option) {
  return "--" + option.name + (option.value.empty() ? "" : " " + shell_quoted(option.value));
}

}  // namespace espdiff::cli
