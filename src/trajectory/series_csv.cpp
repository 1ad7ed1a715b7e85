// series_csv.cpp: writes and reads the head and the rows of a trajectory, under a lock.
#include "trajectory/series_csv.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/system_message.h"
#include "compare/options.h"
#include "io/atomic_file.h"
#include "io/read_csv.h"
#include "io/read_input.h"
#include "io/sha256.h"
#include "io/text_cursor.h"
#include "io/write_csv.h"

namespace espdiff {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::ostringstream line;
  write_csv_row(line, cells);
  return line.str();
}

bool has_content(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && std::filesystem::file_size(path, ignored) != 0;
}

/// Whether the open file still has that name: another run may have removed it before the lock.
bool is_file_named(int descriptor, const std::string& path) {
  struct stat open_file {};
  struct stat named {};
  return ::fstat(descriptor, &open_file) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

/// Every file begins with this.
constexpr const char* kFirstWords = "# espdiff: ";

/// As it is read back.
std::string head_text(const std::string& text) { return std::string(trimmed(one_line(text))); }

auto find(const SeriesHead& head, const std::string& name) {
  return std::find_if(head.begin(), head.end(), [&](const auto& entry) { return entry.first == name; });
}

bool has_comments_only(const std::string& lines) {
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind('#', 0) != 0) return false;
  }
  return true;
}

}  // namespace

SeriesCsv::SeriesCsv(std::string path, SeriesHead head, ExistingFile existing)
    : path_(std::move(path)), head_(std::move(head)) {
  for (auto& entry : head_) entry.second = head_text(entry.second);
  if (has_content(path_) && existing == ExistingFile::kRefuse)
    throw IoError(path_, "the file exists; " + switched_on("resume") + " goes on with it, " + switched_on("overwrite") +
                             " replaces it");
  { const AtomicFile probe(path_); }  // fails now, not after the first frame
  open_and_lock();
  try {
    if (existing == ExistingFile::kResume && has_content(path_)) read_rows();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

void SeriesCsv::open_and_lock() {
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

SeriesCsv::SeriesCsv(SeriesCsv&& other) noexcept
    : path_(std::move(other.path_)),
      head_(std::move(other.head_)),
      rows_(std::move(other.rows_)),
      descriptor_(other.descriptor_),
      has_head_(other.has_head_),
      is_new_(other.is_new_) {
  other.descriptor_ = -1;
}

SeriesCsv::~SeriesCsv() {
  if (descriptor_ < 0) return;
  if (is_new_ && !has_head_) ::unlink(path_.c_str());
  ::close(descriptor_);
}

void SeriesCsv::read_rows() {
  const std::string text = read_text_file(path_);
  // Text after the last line end is an incomplete row of an interrupted run.
  const std::string complete = text.substr(0, text.rfind('\n') + 1);
  if (text.rfind(kFirstWords, 0) == 0 && has_comments_only(complete)) return;  // only a part of the head
  const CsvTable table = parse_csv(complete, path_);
  if (table.columns != series_columns() && table.columns != series_columns(true))
    throw FormatError(path_, static_cast<long>(table.comments.size()) + 1,
                      "this is not this version's line of columns; give another file");
  SeriesHead in_file;
  for (const std::string& comment : table.comments) {
    const std::size_t colon = std::min(comment.find(':'), comment.size());
    const std::string name = comment.substr(0, colon),
                      value = colon + 2 < comment.size() ? comment.substr(colon + 2) : "";
    const auto wanted = find(head_, name);
    if (wanted != head_.end()) check_same(name, value, wanted->second);
    in_file.emplace_back(name, value);
  }
  head_ = std::move(in_file);
  for (const auto& cells : table.rows) rows_.emplace_back(cells);
  has_head_ = true;
  if (complete.size() < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(complete.size())) != 0)
    throw IoError(path_, std::string("the incomplete last row cannot be removed: ") + system_message(errno));
}

void SeriesCsv::check_same(const std::string& name, const std::string& in_file, const std::string& now) const {
  if (in_file == now) return;
  throw InputError(path_ + ": was made with " + name + " '" + in_file + "', not with '" + now + "'; " +
                   switched_on("overwrite") + " begins anew");
}

void SeriesCsv::note(const std::string& name, const std::string& text) {
  const std::string now = head_text(text);
  const auto known = find(head_, name);
  if (known != head_.end()) return check_same(name, known->second, now);
  if (!has_head_) head_.emplace_back(name, now);
}

std::string SeriesCsv::fingerprint() const {
  std::string text;
  for (const auto& [name, value] : head_) text += name + ": " + value + "\n";
  return sha256_of(text);
}

void SeriesCsv::write(const std::string& text) {
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t n = ::write(descriptor_, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw IoError(path_, std::string("a row cannot be written: ") + system_message(errno) + "; " +
                               switched_on("resume") + " goes on after the last complete row");
    written += static_cast<std::size_t>(n);
  }
}

void SeriesCsv::add(const SeriesRow& row) {
  std::string text;
  if (!has_head_) {
    for (const auto& [name, value] : head_) text += "# " + name + ": " + value + "\n";
    text += line_of(row.columns());
    if (::ftruncate(descriptor_, 0) != 0)
      throw IoError(path_, std::string("the file cannot be replaced: ") + system_message(errno));
    has_head_ = true;
  }
  write(text + line_of(row.cells()));
  rows_.push_back(row);
}

}  // namespace espdiff
