// call_gemmi.h: calls gemmi, and makes its errors ours.
#pragma once

#include <cstdlib>
#include <exception>
#include <gemmi/cif.hpp>  // for parse_error
#include <new>
#include <string>

#include "base/error.h"
#include "base/text/printable.h"

namespace espdiff {

/// gemmi's message in our words, which depend on no release of it; the name that it ends with is kept.
inline std::string in_our_words(const std::string& message) {
  struct Words {
    const char *begin, *ours, *behind_name;
  };
  constexpr Words kWords[] = {
      {"Wrong number of values in", "the values of a loop do not fill its columns", nullptr},
      {"unterminated 'string'", "a value in single quotes is not closed on its line", nullptr},
      {"unterminated \"string\"", "a value in double quotes is not closed on its line", nullptr},
      {"unterminated text field", "a text field is not closed by a line that begins with ';'", nullptr},
      {"unnamed save_ frame", "a save frame has no name", nullptr},
      {"expected block header", "a data block was expected, which begins with 'data_NAME'", nullptr},
      {"parse error", "a tag with its value, or a loop, was expected", nullptr},
      {"tag without value", "a tag has no value", nullptr},
      {"empty loop", "a loop has no values", nullptr},
      {"duplicate block name: ", "two data blocks are named '", "'"},
      {"duplicate tag ", "the tag '", "' is given twice"},
      {"duplicate save_", "two save frames are named '", "'"},
      {"2+ blocks are ok", "two data blocks have atoms; keep one", nullptr},
      {"Inconsistent sequence ID: ", "one residue has two numbers or insertion codes, '", "'"},
      {"Inconsistent insertion code in ", "the residue number '", "' has another insertion code than its row"},
      {"Not a single character: ", "an alternate location or insertion code is '", "'; one letter was expected"},
      {"Neither _atom_site.label_comp_id", "the column _atom_site.label_comp_id is missing", nullptr},
      {"Neither _atom_site.label_atom_id", "the column _atom_site.label_atom_id is missing", nullptr},
      {"run out of", "the assembly has more chains than have names of two letters", nullptr}};
  for (const Words& words : kWords) {
    if (message.find(words.begin) != 0) continue;
    if (words.behind_name == nullptr) return words.ours;
    constexpr std::size_t kLongestName = 60;
    return words.ours + printable(message.substr(std::char_traits<char>::length(words.begin), kLongestName)) +
           words.behind_name;
  }
  const std::string end = " has no value";
  if (message.size() > end.size() && message.compare(message.size() - end.size(), end.size(), end) == 0)
    return printable(message);
  return "its text does not follow the format";
}

/// An error whose message may begin with "FILE: " or "FILE:LINE in BLOCK: ", as gemmi's do where the syntax is right.
inline FormatError format_error(const std::string& path, const std::string& problem, const std::string& message) {
  if (message.compare(0, path.size() + 1, path + ":") != 0) return {path, 0, problem + in_our_words(message)};
  const std::string rest = message.substr(path.size() + 1);
  if (rest.compare(0, 1, " ") == 0) return {path, 0, problem + in_our_words(rest.substr(1))};
  const std::size_t words = rest.find(": ");
  return {path, std::strtol(rest.c_str(), nullptr, 10),
          problem + in_our_words(words == std::string::npos ? rest : rest.substr(words + 2))};
}

/// Calls gemmi; whatever it throws (runtime_error, invalid_argument, PEGTL's parse_error) becomes ours.
/// @throws FormatError, MemoryError
template <typename Call>
auto call_gemmi(const std::string& path, const char* problem, Call call) -> decltype(call()) {
  try {
    return call();
  } catch (const tao::pegtl::parse_error& error) {
    throw FormatError(path, static_cast<long>(error.positions().front().line),
                      problem + in_our_words(std::string(error.message())));
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": the structure does not fit into memory");
  } catch (const std::exception& error) {
    throw format_error(path, problem, error.what());
  }
}

}  // namespace espdiff
