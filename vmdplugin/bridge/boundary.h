// boundary.h: the boundary to C: turns each exception into a class name and one line of text.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/text/translate.h"

namespace espdiff {

/// An exception as the other side of a boundary sees it.
struct Failure {
  const char* error_class;  ///< "INPUT", "MEMORY", ...: the CLASS of a Tcl errorcode
  Message message;          ///< one line
};

/// Returns body(), or on_failure(Failure) if body throws; both return the same type. An exception that reached Tcl or
/// VMD would end the program. `on_failure` must not throw.
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
