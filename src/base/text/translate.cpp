// translate.cpp: one row a kind of exception.
#include "base/text/translate.h"

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

namespace espdiff {

Error translated(const std::exception& error) {
  if (const auto* ours = dynamic_cast<const Error*>(&error)) return *ours;
  if (const auto* files = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string path = files->path1().string();
    return IoError(path.empty() ? "a file or folder" : path,
                   "cannot be used: " + files->code().message() + "; check the path and its permissions");
  }
  // Lengths beyond what a container can have are asked for where sizes are nonsense or memory would not do anyway.
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
      dynamic_cast<const std::length_error*>(&error) != nullptr)
    return MemoryError("not enough memory; use a larger " + option("grid-spacing") +
                       ", select fewer atoms, or close other programs");
  if (const auto* system = dynamic_cast<const std::system_error*>(&error))
    return DeviceError("the system refused: " + system->code().message() +
                       "; close other programs, or give a smaller number of threads");
  return {ErrorClass::kInternal, std::string("internal error: ") + error.what() +
                                     "; please report it with the command and, if you can, the input"};
}

}  // namespace espdiff
