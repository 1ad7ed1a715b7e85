// appended_file.h: a text file that grows by whole lines, under a lock; an interrupted run can continue it.
#pragma once

#include <cstddef>
#include <string>

#include "system/open_file.h"

namespace espdiff {

/// What to do with an existing file.
enum class ExistingFile { kRefuse, kResume, kReplace };

/// Without what follows the last line end: an incomplete line, which an interrupted run left.
inline std::string complete_lines(const std::string& text) { return text.substr(0, text.rfind('\n') + 1); }

/// One process at a time writes the file. What append() was given is in the file when it returns, whatever happens to
/// the process then. An existing file keeps its content until clear().
class AppendedFile {
 public:
  /// @throws IoError (the file has content and `existing` is kRefuse, cannot be written, or another run is writing it)
  AppendedFile(std::string path, ExistingFile existing);
  AppendedFile(AppendedFile&& other) noexcept;
  AppendedFile& operator=(AppendedFile&&) = delete;
  /// Removes the file if it was not there before and nothing was written.
  ~AppendedFile();

  const std::string& path() const { return path_; }
  bool has_content() const;
  /// The whole content. @throws IoError
  std::string text() const;
  /// Keeps the first bytes. @throws IoError
  void truncate(std::size_t n_bytes);
  /// @throws IoError
  void append(const std::string& text);

 private:
  void open_and_lock();

  std::string path_;
  OpenFile file_;
  bool is_new_ = false;      ///< it was not there
  bool is_written_ = false;  ///< by this run
};

}  // namespace espdiff
