// appended_file.cpp: opens, locks and extends the file.
#include "io/appended_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/system_message.h"
#include "io/atomic_file.h"
#include "io/read_input.h"

namespace espdiff {

bool is_file_named(int descriptor, const std::string& path) {
  struct stat open_file {};
  struct stat named {};
  return ::fstat(descriptor, &open_file) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

AppendedFile::AppendedFile(std::string path, ExistingFile existing) : path_(std::move(path)) {
  if (has_content() && existing == ExistingFile::kRefuse)
    throw IoError(path_, "the file exists; " + switched_on("resume") + " goes on with it, " + switched_on("overwrite") +
                             " replaces it");
  { const AtomicFile probe(path_); }  // fails now, not after the first frame
  open_and_lock();
}

void AppendedFile::open_and_lock() {
  for (;;) {
    is_new_ = !std::filesystem::exists(path_);
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw IoError(path_, std::string("cannot be written: ") + system_message(errno));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor_);
      throw IoError(path_, "another run is writing this file; wait for its end, or name another output");
    }
    if (is_file_named(descriptor_, path_)) return;
    ::close(descriptor_);
  }
}

AppendedFile::AppendedFile(AppendedFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      is_new_(other.is_new_),
      is_written_(other.is_written_) {}

AppendedFile::~AppendedFile() {
  if (descriptor_ < 0) return;
  if (is_new_ && !is_written_) ::unlink(path_.c_str());
  ::close(descriptor_);
}

bool AppendedFile::has_content() const {
  std::error_code ignored;
  return std::filesystem::exists(path_, ignored) && std::filesystem::file_size(path_, ignored) != 0;
}

std::string AppendedFile::text() const { return read_text_file(path_); }

void AppendedFile::truncate(std::size_t n_bytes) {
  if (::ftruncate(descriptor_, static_cast<off_t>(n_bytes)) != 0)
    throw IoError(path_, std::string("the file cannot be shortened: ") + system_message(errno));
}

void AppendedFile::append(const std::string& text) {
  is_written_ = true;
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t n = ::write(descriptor_, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw IoError(path_, std::string("a row cannot be written: ") + system_message(errno) + "; " +
                               switched_on("resume") + " goes on after the last complete row");
    written += static_cast<std::size_t>(n);
  }
}

}  // namespace espdiff
