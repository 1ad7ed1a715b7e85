// shared_library.cpp: dlopen and dlsym.
#include "system/shared_library.h"

#include <dlfcn.h>

namespace espdiff {

void* load_library(const std::string& name, LibraryUse use) {
  const int flags = use == LibraryUse::kOwn      ? RTLD_NOW | RTLD_LOCAL
                    : use == LibraryUse::kGlobal ? RTLD_NOW | RTLD_GLOBAL
                                                 : RTLD_LAZY | RTLD_GLOBAL;
  return dlopen(name.c_str(), flags);
}

std::string library_problem() {
  const char* const text = dlerror();
  return text == nullptr ? "unknown reason" : text;
}

void* find_symbol(void* library, const char* name) { return dlsym(library, name); }

}  // namespace espdiff
