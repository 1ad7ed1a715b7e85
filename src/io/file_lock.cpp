// file_lock.cpp: flock on a file beside the output.
#include "io/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"

namespace espdiff {
namespace {

/// Whether the name still means the file that was opened: its holder removes it when it ends.
bool is_still_named(int descriptor, const std::string& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

FileLock::FileLock(const std::string& path) : lock_path_(followed_links(path) + ".lock") {
  check_writable(path);
  for (;;) {
    descriptor_ = ::open(lock_path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw IoError(path, std::string("cannot write beside it: ") + std::strerror(errno) + "; choose another folder");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      ::close(std::exchange(descriptor_, -1));
      throw IoError(path, "another run is writing this file; wait for it, or name another output");
    }
    if (is_still_named(descriptor_, lock_path_)) {
      remove_stale_temporaries(path);
      return;
    }
    ::close(std::exchange(descriptor_, -1));
  }
}

FileLock::FileLock(FileLock&& other) noexcept
    : lock_path_(std::move(other.lock_path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(lock_path_.c_str());  // while it is locked: nobody else can hold it
  ::close(descriptor_);
}

}  // namespace espdiff
