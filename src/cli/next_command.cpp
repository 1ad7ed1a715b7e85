// next_command.cpp: what was typed, with changes, in a shell's words.
#include "cli/next_command.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "base/error.h"
#include "cli/spelling.h"
#include "field/field_kinds.h"

namespace espdiff::cli {

namespace {

/// Removes an option with its value. @param is_meant  of its value
TypedWords without(TypedWords words, const std::string& name, const std::function<bool(const std::string&)>& is_meant) {
  for (std::size_t i = 0; i < words.size();) {
    const bool is_joined = words[i].rfind(name + "=", 0) == 0, is_it = is_joined || words[i] == name;
    const bool has_value = !is_joined && i + 1 < words.size();
    const std::string value = is_joined ? words[i].substr(name.size() + 1) : has_value ? words[i + 1] : "";
    if (is_it && is_meant(value))
      words.erase(words.begin() + static_cast<long>(i), words.begin() + static_cast<long>(i + (has_value ? 2 : 1)));
    else
      ++i;
  }
  return words;
}

bool is_of_potential(const std::string& fields) {
  try {
    const std::vector<Field> made = make_fields(parse_fields(fields));
    return std::any_of(made.begin(), made.end(), [](const Field& field) { return field.of_potential; });
  } catch (const Error&) {
    return false;  // what is wrong with it is told when it is its turn
  }
}

/// What `--potential none` would refuse is left out with it.
TypedWords without_what_needs_potential(TypedWords words) {
  words = without(std::move(words), "--patches-of",
                  [](const std::string& value) { return value.rfind("potential", 0) == 0; });
  words = without(std::move(words), "--causes", [](const std::string&) { return true; });
  return without(std::move(words), "--field", is_of_potential);
}

}  // namespace

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
    if (option.name == "potential" && option.value == "none") words = without_what_needs_potential(std::move(words));
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
