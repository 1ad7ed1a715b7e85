// error.h: the error classes; thrown where a check fails, converted once per boundary (exit status, Tcl, molfile).
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "base/message.h"

namespace espdiff {

/// Kind of failure; the names are the CLASS of a Tcl errorcode.
enum class ErrorClass { kInput, kFormat, kIo, kGeometry, kConvergence, kDevice, kMemory, kCancelled, kInternal };

/// The upper-case name of a class, such as "INPUT".
const char* error_class_name(ErrorClass error_class);

/// Base of everything espdiff throws. The message is one line: what, where, the value, the limit, and the next step.
/// what() has options by their bare names; front ends show message() with their own spelling.
class Error : public std::runtime_error {
 public:
  Error(ErrorClass error_class, const Message& message)
      : std::runtime_error(message.plain()), error_class_(error_class), message_(std::make_shared<Message>(message)) {}

  ErrorClass error_class() const { return error_class_; }
  const Message& message() const { return *message_; }

  /// Exit status of the command line: 2 for wrong usage or input, 1 if the computation failed.
  int exit_status() const;

 private:
  ErrorClass error_class_;
  std::shared_ptr<const Message> message_;  ///< shared, so that copying an error cannot fail
};

/// Invalid request: a wrong option value, an empty atom selection, a missing map.
struct InputError : Error {
  explicit InputError(const Message& message) : Error(ErrorClass::kInput, message) {}
};

/// A file's content is wrong. `line` counts from 1; 0 for formats without lines.
struct FormatError : Error {
  FormatError(const std::string& path, long line, const Message& message);
};

/// The operating system refused: open, read, write, rename.
struct IoError : Error {
  IoError(const std::string& path, const Message& message);
};

/// The shapes cannot be processed: no surface at this isovalue, too few paired atoms.
struct GeometryError : Error {
  explicit GeometryError(const Message& message) : Error(ErrorClass::kGeometry, message) {}
};

/// An iteration failed in a way that leaves no usable result.
struct ConvergenceError : Error {
  explicit ConvergenceError(const Message& message) : Error(ErrorClass::kConvergence, message) {}
};

/// The chosen back end is missing or failed.
struct DeviceError : Error {
  explicit DeviceError(const Message& message) : Error(ErrorClass::kDevice, message) {}
};

/// A grid or mesh does not fit into memory.
struct MemoryError : Error {
  explicit MemoryError(const Message& message) : Error(ErrorClass::kMemory, message) {}
};

/// The user cancelled; nothing was written.
struct Cancelled : Error {
  Cancelled() : Error(ErrorClass::kCancelled, "cancelled; nothing was written") {}
};

}  // namespace espdiff
