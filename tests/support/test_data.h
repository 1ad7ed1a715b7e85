// test_data.h: where tests find real inputs and write their files, and how they report skipping.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace espdiff_test {

/// The folder of real inputs: $ESPDIFF_DATA, otherwise shared/data beside the checkout; empty if neither exists.
inline std::string data_folder() {
  const char* from_environment = std::getenv("ESPDIFF_DATA");
  const std::string folder = from_environment != nullptr ? from_environment : ESPDIFF_SOURCE_DIR "/../shared/data";
  return std::filesystem::is_directory(folder) ? folder : std::string();
}

/// Path of a real input, or nothing (after a line with SKIPPED and the reason) if the folder is absent.
inline std::optional<std::string> real_input(const std::string& name) {
  const std::string folder = data_folder();
  if (folder.empty()) {
    MESSAGE("SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder (wanted: ", name, ")");
    return std::nullopt;
  }
  return folder + "/" + name;
}

/// An empty folder for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "espdiff-test-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
    return file(name);
  }
  std::size_t n_files() const {
    std::size_t n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) n += entry.exists() ? 1 : 0;
    return n;
  }

 private:
  std::string path_;
};

inline std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The message of the exception that `call` throws; "(nothing thrown)" if it returns.
template <typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

}  // namespace espdiff_test
