// check_outputs.cpp: compares files by device and inode, and names by their folders.
#include "io/check_outputs.h"

#include <filesystem>

#include "base/error.h"
#include "io/atomic_file.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

/// Devices such as /dev/null are written by none of our writers, and read by many.
bool is_file(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// The folder's real path and the name in it; of a link that points nowhere, that of what it would be.
fs::path place_of(const std::string& path) {
  const fs::path target = followed_links(path);
  std::error_code error;
  const fs::path folder = fs::canonical(target.has_parent_path() ? target.parent_path() : fs::path("."), error);
  return (error ? target.parent_path() : folder) / target.filename();
}

std::string both_names(const std::string& a, const std::string& b) {
  return a == b ? "'" + a + "'" : "'" + a + "' and '" + b + "', which are one file";
}

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const bool has_a = is_file(a), has_b = is_file(b);
  if (has_a && has_b) return fs::equivalent(a, b, error);
  return has_a == has_b && place_of(a) == place_of(b);
}

void check_outputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) continue;
    for (const std::string& input : inputs) {
      if (!input.empty() && is_same_file(input, outputs[i]))
        throw InputError("an output would replace an input: " + both_names(outputs[i], input) +
                         "; choose another name for the output");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!outputs[j].empty() && is_same_file(outputs[j], outputs[i]))
        throw InputError("two outputs would have one name: " + both_names(outputs[j], outputs[i]) +
                         "; choose another for one of them");
    }
  }
}

}  // namespace espdiff
