// temporary_folder.cpp: folders that their process locks, so that those of dead ones can be told.
#include "io/temporary_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStart = "espdiff-prepare-";

/// Ours, and no link: /tmp belongs to everyone.
bool is_own_folder(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid();
}

/// A folder that its process holds open, locked; -1 if another one does.
int locked(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

/// Removes the folders of dead processes, which hold no lock. Their programs may still run: they fail then.
void remove_left_behind(const std::string& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().filename().string().rfind(kStart, 0) != 0 || !is_own_folder(entry.path())) continue;
    const int descriptor = locked(entry.path().string());
    if (descriptor < 0) continue;
    fs::remove_all(entry.path(), ignored);
    ::close(descriptor);
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  // VMD may name a folder in TMPDIR that is not there.
  const char* const named = std::getenv("TMPDIR");
  std::error_code ignored;
  const bool is_there = named != nullptr && fs::is_directory(named, ignored);
  // Absolute, since a program works in this folder, and a name that begins with a dash would be an option of it.
  const std::string wanted = is_there ? fs::absolute(named, ignored).string() : std::string();
  for (const std::string& folder : {wanted.empty() ? std::string("/tmp") : wanted, std::string("/tmp")}) {
    remove_left_behind(folder);
    path_ = folder + "/" + kStart + "XXXXXX";
    if (::mkdtemp(path_.data()) == nullptr) continue;
    descriptor_ = locked(path_);
    if (descriptor_ >= 0) return;
  }
  throw IoError(path_, "a temporary folder cannot be made; name one that can be written to in TMPDIR");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  ::close(descriptor_);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream << content;
  stream.close();
  if (!stream) throw IoError(file(name), "cannot be written; is the disk full? Name another folder in TMPDIR");
  return file(name);
}

}  // namespace espdiff
