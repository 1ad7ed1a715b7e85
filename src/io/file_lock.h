// file_lock.h: keeps a second run, of this process or another, from writing the same file.
#pragma once

#include <string>

namespace espdiff {

/// Holds PATH.lock, a file beside the output, with an advisory lock of the kernel's (flock). The file goes with the
/// object; what a killed process left is taken over, since its lock went with it.
class FileLock {
 public:
  /// Also removes temporary files that a killed run left beside PATH.
  /// @throws IoError when another run holds it, or PATH cannot be written
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  FileLock& operator=(FileLock&&) = delete;

 private:
  std::string lock_path_;
  int descriptor_ = -1;
};

}  // namespace espdiff
