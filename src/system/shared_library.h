// shared_library.h: libraries that are loaded while the program runs, so that it starts without them.
#pragma once

#include <string>

namespace espdiff {

enum class LibraryUse {
  kOwn,     ///< its functions are found by find_function() alone
  kGlobal,  ///< libraries that are loaded later find its functions too
  kLazy,    ///< as kGlobal; functions that it needs may be missing until they are called
};

/// Loads a library by its name or path; it stays loaded. One that lacks a library or a function of others is not
/// loaded, unless `kLazy`. @returns null if it cannot be loaded
void* load_library(const std::string& name, LibraryUse use);

/// Null if the library has no such function.
void* find_symbol(void* library, const char* name);

/// Why the last load_library() of this thread failed, in the system's words.
std::string library_problem();

template <typename Function>
Function find_function(void* library, const char* name) {
  return reinterpret_cast<Function>(find_symbol(library, name));
}

}  // namespace espdiff
