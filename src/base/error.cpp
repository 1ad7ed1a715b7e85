// error.cpp: names and exit statuses of the error classes.
#include "base/error.h"

namespace espdiff {

const char* error_class_name(ErrorClass error_class) {
  switch (error_class) {
    case ErrorClass::kInput: return "INPUT";
    case ErrorClass::kFormat: return "FORMAT";
    case ErrorClass::kIo: return "IO";
    case ErrorClass::kGeometry: return "GEOMETRY";
    case ErrorClass::kConvergence: return "CONVERGENCE";
    case ErrorClass::kDevice: return "DEVICE";
    case ErrorClass::kMemory: return "MEMORY";
    case ErrorClass::kCancelled: return "CANCELLED";
    case ErrorClass::kInternal: return "INTERNAL";
  }
  return "INTERNAL";
}

int Error::exit_status() const {
  switch (error_class_) {
    case ErrorClass::kInput:
    case ErrorClass::kFormat:
    case ErrorClass::kIo: return 2;
    default: return 1;
  }
}

FormatError::FormatError(const std::string& path, long line, const Message& message)
    : Error(ErrorClass::kFormat, path + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + message) {}

IoError::IoError(const std::string& path, const Message& message) : Error(ErrorClass::kIo, path + ": " + message) {}

}  // namespace espdiff
