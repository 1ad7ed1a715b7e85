// call_gemmi.h: calls gemmi, and makes its errors ours.
#pragma once

#include <algorithm>
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

/// Calls gemmi; whatever it throws (runtime_error, invalid_argument, PEGTL's parse_error) becomes ours.
/// @throws FormatError, MemoryError
template <typename Call>
auto call_gemmi(const std::string& path, const char* problem, Call call) -> decltype(call()) {
  try {
    return call();
  } catch (const tao::pegtl::parse_error& error) {
    throw FormatError(path, static_cast<long>(error.positions().front().line),
                      problem + one_line(std::string(error.message())));
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": the structure does not fit into memory");
  } catch (const std::exception& error) {
    throw FormatError(path, 0, problem + one_line(error.what()));
  }
}

}  // namespace espdiff
