// load_module.cpp: finds a module beside the program.
#include "cli/modules/load_module.h"

#include <filesystem>
#include <system_error>

#include "base/version.h"
#include "system/shared_library.h"
#include "system/this_process.h"

namespace espdiff {

const void* load_module(const ProgramModule& module, std::string& problem) {
  const std::filesystem::path folder = std::filesystem::path(own_program()).parent_path().parent_path();
  const std::string path = (folder / "lib" / "espdiff" / module.file).string();
  problem = "this program's part with " + module.contents + ", " + path + ", ";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    problem += "is missing; install espdiff as a whole, not the program alone";
    return nullptr;
  }
  void* const library = load_library(path, LibraryUse::kOwn);
  if (library == nullptr) {
    problem += "cannot be loaded (" + library_problem() + "); install " + module.libraries;
    return nullptr;
  }
  const auto functions_of = find_function<const void* (*)()>(library, "espdiff_module");
  const void* const functions = functions_of == nullptr ? nullptr : functions_of();
  if (functions == nullptr || std::string(*static_cast<const char* const*>(functions)) != kVersion) {
    problem += "is not of version " + std::string(kVersion) + "; install espdiff as a whole again";
    return nullptr;
  }
  problem.clear();
  return functions;
}

}  // namespace espdiff
