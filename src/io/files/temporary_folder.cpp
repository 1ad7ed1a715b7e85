// temporary_folder.cpp: folders that their process locks, so that those of dead ones can be told.
#include "io/files/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/error.h"
#include "system/permissions.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStart = "espdiff-prepare-";

/// A folder that its process holds open, locked; not open if another process does.
OpenFile locked(const std::string& path) {
  OpenFile folder(path, FileAccess::kFolder);
  if (folder && folder.lock() != LockResult::kLocked) folder.close();
  return folder;
}

/// Removes the folders of dead processes, which hold no lock. Their programs may still run: they fail then.
void remove_left_behind(const std::string& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().filename().string().rfind(kStart, 0) != 0 || !is_own_folder(entry.path().string())) continue;
    if (const OpenFile of_dead_process = locked(entry.path().string())) fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  // A folder is locked a moment after it was made: another thread must not take it for a dead process' before.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> guard(one_at_a_time);
  // VMD may name a folder in TMPDIR that is not there.
  const char* const named = std::getenv("TMPDIR");
  std::error_code ignored;
  const bool is_there = named != nullptr && fs::is_directory(named, ignored);
  // Absolute, since a program works in this folder, and a name that begins with a dash would be an option of it.
  const std::string wanted = is_there ? fs::absolute(named, ignored).string() : std::string();
  for (const std::string& folder : {wanted.empty() ? std::string("/tmp") : wanted, std::string("/tmp")}) {
    remove_left_behind(folder);
    path_ = make_private_folder(folder + "/" + kStart);
    if (path_.empty()) continue;
    lock_ = locked(path_);
    if (lock_) return;
  }
  throw IoError("/tmp", "a temporary folder cannot be made; name one that can be written to in TMPDIR");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream << content;
  stream.close();
  if (!stream) throw IoError(file(name), "cannot be written; is the disk full? Name another folder in TMPDIR");
  return file(name);
}

}  // namespace espdiff
