// open_file.cpp: POSIX calls, repeated where a signal interrupts them.
#include "system/open_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace espdiff {
namespace {

int flags_of(FileAccess access) {
  switch (access) {
    case FileAccess::kRead: return O_RDONLY;
    case FileAccess::kReadPipe: return O_RDONLY | O_NONBLOCK;
    case FileAccess::kReadWrite: return O_RDWR;
    case FileAccess::kAppend: return O_WRONLY | O_APPEND;
    case FileAccess::kAppendOrCreate: return O_RDWR | O_CREAT | O_APPEND;
    case FileAccess::kCreateNew: return O_RDWR | O_CREAT | O_EXCL;
#if defined(O_TMPFILE)
    case FileAccess::kUnnamed: return O_TMPFILE | O_RDWR;
#else
    case FileAccess::kUnnamed: return -1;
#endif
    case FileAccess::kFolder: return O_RDONLY | O_DIRECTORY | O_NOFOLLOW;
  }
  return -1;
}

/// Calls until all bytes are done.
/// @param call (bytes done before) returns bytes done, as ::read does
template <typename Call>
int repeat(std::size_t n, std::size_t& n_done, const Call& call) {
  for (n_done = 0; n_done < n;) {
    const ssize_t done = call(n_done);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    if (done == 0) return OpenFile::kEndsTooEarly;
    n_done += static_cast<std::size_t>(done);
  }
  return 0;
}

/// A device that takes nothing is full.
int error_of_writing(int error) { return error == OpenFile::kEndsTooEarly ? ENOSPC : error; }

}  // namespace

OpenFile::OpenFile(const std::string& path, FileAccess access) {
  const int flags = flags_of(access);
  constexpr mode_t kLessTheUsersMask = 0666;
  if (flags >= 0) descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, kLessTheUsersMask);
  if (descriptor_ < 0) error_ = flags < 0 ? ENOTSUP : errno;
}

OpenFile OpenFile::in_memory() {
  OpenFile file;
  file.descriptor_ = ::memfd_create("espdiff", MFD_CLOEXEC);
  if (file.descriptor_ < 0) file.error_ = errno;
  return file;
}

OpenFile::OpenFile(OpenFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), error_(other.error_) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(error_, other.error_);
  return *this;
}

OpenFile::~OpenFile() { close(); }

int OpenFile::close() {
  if (descriptor_ < 0) return 0;
  return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno;
}

LockResult OpenFile::lock() {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return LockResult::kLocked;
  return errno == EWOULDBLOCK ? LockResult::kBusy : LockResult::kImpossible;
}

bool OpenFile::is_named(const std::string& path) const {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor_, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

std::uint64_t OpenFile::size() const {
  struct stat status {};
  return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

int OpenFile::read(char* buffer, std::size_t size, std::size_t& n_read) {
  const int error =
      repeat(size, n_read, [&](std::size_t done) { return ::read(descriptor_, buffer + done, size - done); });
  return error == kEndsTooEarly ? 0 : error;
}

int OpenFile::read_at(std::uint64_t offset, void* bytes, std::size_t n) const {
  std::size_t n_read = 0;
  return repeat(n, n_read, [&](std::size_t done) {
    return ::pread(descriptor_, static_cast<char*>(bytes) + done, n - done, static_cast<off_t>(offset + done));
  });
}

int OpenFile::write(const void* bytes, std::size_t n) {
  std::size_t n_written = 0;
  return error_of_writing(repeat(n, n_written, [&](std::size_t done) {
    return ::write(descriptor_, static_cast<const char*>(bytes) + done, n - done);
  }));
}

int OpenFile::write_at(std::uint64_t offset, const void* bytes, std::size_t n) {
  std::size_t n_written = 0;
  return error_of_writing(repeat(n, n_written, [&](std::size_t done) {
    return ::pwrite(descriptor_, static_cast<const char*>(bytes) + done, n - done, static_cast<off_t>(offset + done));
  }));
}

void OpenFile::rewind() { ::lseek(descriptor_, 0, SEEK_SET); }

int OpenFile::truncate(std::uint64_t n_bytes) {
  return ::ftruncate(descriptor_, static_cast<off_t>(n_bytes)) == 0 ? 0 : errno;
}

bool OpenFile::wait_until_readable(int milliseconds) const {
  pollfd file{descriptor_, POLLIN, 0};
  return poll(&file, 1, milliseconds) > 0;
}

int OpenFile::read_what_is_there(char* buffer, std::size_t size, std::size_t& n_read) {
  const ssize_t n = ::read(descriptor_, buffer, size);
  n_read = n < 0 ? 0 : static_cast<std::size_t>(n);
  if (n >= 0) return 0;
  return errno == EAGAIN || errno == EINTR ? kNothingYet : errno;
}

std::string OpenFile::own_path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

int OpenFile::link_as(const std::string& path) const {
  return ::linkat(AT_FDCWD, own_path().c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

}  // namespace espdiff
