// fuzz_file.h: hands bytes to a reader as a file, and ends the process for whatever is not one line of ours.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/error.h"
#include "base/text/printable.h"

namespace espdiff_fuzz {

/// A file in memory that keeps its name from one input to the next.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& bytes = "")
      : descriptor_(memfd_create("fuzz", 0)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {
    set(bytes);
  }

  const std::string& path() const { return path_; }
  void set(const std::string& bytes) {
    if (ftruncate(descriptor_, 0) != 0) std::abort();
    replace(0, bytes);
  }
  /// Writes over a part of the file.
  void replace(std::size_t at, const std::string& bytes) {
    if (pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at)) != static_cast<ssize_t>(bytes.size()))
      std::abort();
  }

 private:
  int descriptor_;
  std::string path_;
};

/// Errors of ours must name the file; that they are one line is made sure of where they are shown (printable()).
template <typename Read>
int read_memory_file(const MemoryFile& file, Read read) {
  try {
    read(file.path());
  } catch (const espdiff::Error& error) {
    const std::string message = espdiff::printable(error.what());
    if (message.find(file.path()) != std::string::npos) return 0;
    std::fprintf(stderr, "does not name the file: %s\n", message.c_str());
    std::abort();
  }
  return 0;
}

/// Reads `bytes` through a file.
template <typename Read>
int read_as_file(const std::string& bytes, Read read) {
  static MemoryFile file;
  file.set(bytes);
  return read_memory_file(file, read);
}

inline std::string bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace espdiff_fuzz
