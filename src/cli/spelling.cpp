// spelling.cpp: how the command line writes the options that messages name.
#include "cli/spelling.h"

namespace espdiff::cli {

namespace {

/// The value as a shell takes it: parentheses, blanks and the like in quotes.
std::string quoted(const std::string& value) {
  const bool plain = value.find_first_of(" ()*;&|<>?[]$\"\\!") == std::string::npos;
  return plain || value.find('\'') != std::string::npos ? value : "'" + value + "'";
}

}  // namespace

std::string spelled_option(const NamedOption& option) {
  return "--" + option.name + (option.value.empty() ? "" : " " + quoted(option.value));
}

}  // namespace espdiff::cli
