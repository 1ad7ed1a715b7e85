// translate.h: what the standard library throws, in our words, for the boundaries that show it to a user.
#pragma once

#include <exception>

#include "base/error.h"

namespace espdiff {

/// An Error keeps its class and text. Others become one: of files IO with the path and the system's reason, of memory
/// MEMORY, of the system (no thread, no process) DEVICE; what is left is a mistake of ours, INTERNAL, and says so.
Error translated(const std::exception& error);

}  // namespace espdiff
