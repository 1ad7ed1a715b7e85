// appended_file.cpp: opens, locks and extends the file.
#include "io/files/appended_file.h"

#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/text/system_message.h"
#include "io/files/atomic_file.h"
#include "io/files/read_input.h"

namespace espdiff {

AppendedFile::AppendedFile(std::string path, ExistingFile existing) : path_(std::move(path)) {
  if (has_content() && existing == ExistingFile::kRefuse)
    throw IoError(path_, "the file exists; " + switched_on("resume") + " continues it, " + switched_on("overwrite") +
                             " replaces it");
  { const AtomicFile probe(path_); }  // fails now, not after the first frame
  open_and_lock();
}

void AppendedFile::open_and_lock() {
  for (;;) {
    is_new_ = !std::filesystem::exists(path_);
    file_ = OpenFile(path_, FileAccess::kAppendOrCreate);
    if (!file_) throw IoError(path_, std::string("cannot be written: ") + system_message(file_.error()));
    if (file_.lock() == LockResult::kBusy)
      throw IoError(path_, "another run is writing this file; wait for its end, or name another output");
    if (file_.is_named(path_)) return;
  }
}

AppendedFile::AppendedFile(AppendedFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::move(other.file_)),
      is_new_(other.is_new_),
      is_written_(other.is_written_) {}

AppendedFile::~AppendedFile() {
  std::error_code ignored;
  if (file_ && is_new_ && !is_written_) std::filesystem::remove(path_, ignored);
}

bool AppendedFile::has_content() const {
  std::error_code ignored;
  return std::filesystem::exists(path_, ignored) && std::filesystem::file_size(path_, ignored) != 0;
}

std::string AppendedFile::text() const { return read_text_file(path_); }

void AppendedFile::truncate(std::size_t n_bytes) {
  const int error = file_.truncate(n_bytes);
  if (error != 0) throw IoError(path_, std::string("the file cannot be shortened: ") + system_message(error));
}

void AppendedFile::append(const std::string& text) {
  is_written_ = true;
  const int error = file_.write(text.data(), text.size());
  if (error != 0)
    throw IoError(path_, std::string("a row cannot be written: ") + system_message(error) + "; " +
                             switched_on("resume") + " continues after the last complete row");
}

}  // namespace espdiff
