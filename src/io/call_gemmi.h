// call_gemmi.h: calls gemmi, and makes its errors ours.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <gemmi/cif.hpp>  // for parse_error
#include <new>
#include <string>

#include "base/error.h"

namespace espdiff {

/// gemmi's messages can have several lines; ours have one.
inline std::string one_line(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

/// The words of gemmi's releases differ where a table has too few or too many values; these are ours.
inline std::string in_our_words(const std::string& message) {
  if (message.find("Wrong number of values in") == 0) return "the values of a loop do not fill its columns";
  return one_line(message);
}

/// An error whose message may begin with "FILE:LINE in BLOCK: ", as gemmi's do where the syntax is right.
inline FormatError format_error(const std::string& path, const std::string& problem, const std::string& message) {
  if (message.compare(0, path.size() + 1, path + ":") != 0) return {path, 0, problem + one_line(message)};
  const std::size_t words = message.find(": ", path.size() + 1);
  const long line = std::strtol(message.c_str() + path.size() + 1, nullptr, 10);
  return {path, line, problem + one_line(words == std::string::npos ? message : message.substr(words + 2))};
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
