// permissions.cpp: asks the file system.
#include "system/permissions.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace espdiff {

bool may_write(const std::string& path) { return ::access(path.c_str(), W_OK) == 0; }

bool may_run(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(path.c_str(), X_OK) == 0;
}

std::string file_identity(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

bool is_own_folder(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid();
}

std::string make_private_folder(const std::string& start) {
  std::string path = start + "XXXXXX";
  return ::mkdtemp(path.data()) != nullptr ? path : std::string();
}

}  // namespace espdiff
