// cache.cpp: one file for each output, whose last line has its SHA-256.
#include "prepare/charges/cache.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/files/atomic_file.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"

namespace espdiff {
namespace {

constexpr const char* kMark = "REMARK espdiff ";

std::string path_of(const std::string& key) { return cache_folder() + "/" + key + ".pqr"; }

void delete_oldest(const std::string& folder) {
  constexpr std::size_t kMostFiles = 500;
  namespace fs = std::filesystem;
  std::error_code ignored;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".pqr") files.emplace_back(entry.last_write_time(ignored), entry.path());
  }
  if (files.size() <= kMostFiles) return;
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < files.size() - kMostFiles; ++i) fs::remove(files[i].second, ignored);
}

}  // namespace

std::string cache_folder() {
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && *xdg == '/') return std::string(xdg) + "/espdiff/prepare";
  const char* const home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? std::string(home) + "/.cache/espdiff/prepare" : std::string();
}

std::optional<std::string> find_in_cache(const std::string& key) {
  std::error_code ignored;
  if (cache_folder().empty() || !std::filesystem::is_regular_file(path_of(key), ignored)) return std::nullopt;
  try {
    std::string content = read_input(path_of(key)).content;
    const std::size_t mark = content.rfind(kMark);
    if (mark == std::string::npos) return std::nullopt;
    const std::string expected = kMark + sha256_of(content.substr(0, mark)) + "\n";
    if (content.substr(mark) != expected) return std::nullopt;
    content.resize(mark);
    return content;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void keep_in_cache(const std::string& key, const std::string& output) {
  const std::string folder = cache_folder();
  std::error_code error;
  if (folder.empty()) return;
  std::filesystem::create_directories(folder, error);
  if (error) return;
  try {
    AtomicFile file(path_of(key));
    file.stream() << output << kMark << sha256_of(output) << '\n';
    file.commit();
    delete_oldest(folder);
  } catch (const Error&) {  // a full disk, a folder that is read-only
  }
}

}  // namespace espdiff
