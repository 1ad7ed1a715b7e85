// boundary.h: where C calls us: no exception passes; each becomes a class name and one line of text.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/translate.h"

namespace espdiff {

/// What the other side of a boundary learns of an exception.
struct Failure {
  const char* error_class;  ///< "INPUT", "MEMORY", ...: the CLASS of a Tcl errorcode
  Message message;          ///< one line
};

/// Returns body(), or on_failure(Failure) when body throws anything at all; both return the same type. Tcl and VMD are
/// C and C++ of other compilers: an exception that reached them would end the program. `on_failure` must not throw.
template <typename Body, typename OnFailure>
auto boundary(Body&& body, OnFailure&& on_failure) noexcept -> decltype(body()) {
  try {
    return std::forward<Body>(body)();
  } catch (const std::exception& error) {
    const Error ours = translated(error);
    return on_failure(Failure{error_class_name(ours.error_class()), ours.message()});
  } catch (...) {
    return on_failure(
        Failure{error_class_name(ErrorClass::kInternal),
                Message("internal error: an exception of unknown type; please report it with the command")});
  }
}

}  // namespace espdiff
