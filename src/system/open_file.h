// open_file.h: an open file of the operating system: locks, whole reads and writes, files without a name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace espdiff {

enum class FileAccess {
  kRead,
  kReadPipe,  ///< waits neither for who writes into it nor for what is written
  kReadWrite,
  kAppend,          ///< each write at the end of an existing file
  kAppendOrCreate,  ///< to be read as well
  kCreateNew,       ///< fails if the name is taken, by a link too
  kUnnamed,         ///< a new file in a folder, which has no name; not everywhere
  kFolder           ///< the folder itself, and no link to one
};

enum class LockResult { kLocked, kBusy, kImpossible };

/// Closes the file at its end. Functions that return an int return 0, or the error's number for system_message().
class OpenFile {
 public:
  /// Returned where the file ends before what is asked for.
  static constexpr int kEndsTooEarly = -1;
  static constexpr int kNothingYet = -2;

  OpenFile() = default;
  /// New files get the permissions that the user's files get. Programs that are started do not get the file.
  OpenFile(const std::string& path, FileAccess access);
  /// A file in memory: neither a full disk nor a missing folder for temporary files matters.
  static OpenFile in_memory();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;
  ~OpenFile();

  explicit operator bool() const { return descriptor_ >= 0; }
  /// Why it was not opened.
  int error() const { return error_; }
  int descriptor() const { return descriptor_; }
  /// A write that failed late may show here.
  int close();

  /// For this process alone, until the file is closed; does not wait.
  LockResult lock();
  /// Whether the path still names this file: another process may have removed it, or put another one in its place.
  bool is_named(const std::string& path) const;
  /// 0 where it cannot be told.
  std::uint64_t size() const;

  /// Reads until the buffer is full or the file ends. @param n_read bytes, also after an error
  int read(char* buffer, std::size_t size, std::size_t& n_read);
  int read_at(std::uint64_t offset, void* bytes, std::size_t n) const;
  int write(const void* bytes, std::size_t n);
  int write_at(std::uint64_t offset, const void* bytes, std::size_t n);
  void rewind();
  int truncate(std::uint64_t n_bytes);

  /// Of a pipe: waits for something to read, or for the end. @returns false if there was neither within the time, or a
  /// signal came
  bool wait_until_readable(int milliseconds) const;
  /// Of a pipe: reads what is there. @returns kNothingYet where somebody has it open and has written nothing
  int read_what_is_there(char* buffer, std::size_t size, std::size_t& n_read);

  /// A path that names the open file for this process, whether it has a name or not; it may lead nowhere.
  std::string own_path() const;
  /// Gives a file without a name one.
  int link_as(const std::string& path) const;

 private:
  int descriptor_ = -1;
  int error_ = 0;
};

}  // namespace espdiff
