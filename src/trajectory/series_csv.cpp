// series_csv.cpp: writes and reads the head and the rows of a trajectory, under a lock.
#include "trajectory/series_csv.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "io/files/read_csv.h"
#include "io/files/sha256.h"
#include "io/files/write_csv.h"
#include "io/text/text_cursor.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// Every file begins with this.
constexpr const char* kFirstWords = "# espdiff: ";

/// As it is read back.
std::string head_text(const std::string& text) { return std::string(trimmed(one_line(text))); }

auto find_entry(const SeriesHead& head, const std::string& name) {
  return std::find_if(head.begin(), head.end(), [&](const auto& entry) { return entry.first == name; });
}

std::vector<std::string> file_columns(std::vector<std::string> columns) {
  columns.emplace_back(SeriesCsv::kChecksumColumn);
  return columns;
}

/// The checksum of a row that follows what has the checksum `before`; each cell with its length.
std::string sum_of(const std::string& before, const std::vector<std::string>& cells) {
  constexpr std::size_t kDigits = 16;
  std::string text = before;
  for (const std::string& cell : cells) text += " " + std::to_string(cell.size()) + ":" + cell;
  return sha256_of(text).substr(0, kDigits);
}

bool has_comments_only(const std::string& lines) {
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind('#', 0) != 0) return false;
  }
  return true;
}

}  // namespace

SeriesCsv::SeriesCsv(std::string path, SeriesHead head, ExistingFile existing, PartsAndFields compared)
    : file_(std::move(path), existing), head_(std::move(head)), compared_(std::move(compared)) {
  for (auto& entry : head_) entry.second = head_text(entry.second);
  if (existing == ExistingFile::kResume && file_.has_content()) read_rows();
}

void SeriesCsv::read_rows() {
  const std::string text = file_.text(), first_words = kFirstWords;
  const std::string lines = complete_lines(text);
  if (first_words.rfind(text, 0) == 0) return;                              // cut off in the first words
  if (text.rfind(first_words, 0) == 0 && has_comments_only(lines)) return;  // only a part of the head
  const CsvTable table = parse_csv(lines, path());
  SeriesHead in_file;
  for (const std::string& comment : table.comments) {
    const std::size_t colon = std::min(comment.find(':'), comment.size());
    const std::string name = comment.substr(0, colon),
                      value = colon + 2 < comment.size() ? comment.substr(colon + 2) : "";
    in_file.emplace_back(name, value);
    const auto wanted = find_entry(head_, name);
    if (wanted != head_.end()) check_same(name, value, wanted->second);
    if (wanted == head_.end()) unconfirmed_.insert(name);
  }
  if (table.columns != file_columns(series_columns(compared_)))
    throw FormatError(path(), static_cast<long>(table.comments.size()) + 1,
                      "this is not this version's line of columns; give another file");
  for (const auto& [name, now] : head_) {
    if (find_entry(in_file, name) == in_file.end()) refuse_new(name, now);
  }
  head_ = std::move(in_file);
  begin_checksums();
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    std::vector<std::string> cells = table.rows[i];
    const std::string there = cells.back();
    cells.pop_back();
    sum_ = sum_of(sum_, cells);
    if (there != sum_)
      throw FormatError(path(), table.lines[i],
                        "this row, or the head above it, was changed or is damaged: its checksum is " + there +
                            ", not " + sum_ + "; remove this row and all after it, or begin anew (" +
                            switched_on("overwrite") + ")");
    rows_.emplace_back(std::move(cells), compared_);
  }
  has_head_ = is_resumed_ = true;
  file_.truncate(lines.size());
}

void SeriesCsv::check_same(const std::string& name, const std::string& in_file, const std::string& now) const {
  if (in_file == now) return;
  throw InputError(path() + ": was made with " + name + " '" + in_file + "', not with '" + now + "'; " +
                   switched_on("overwrite") + " begins anew");
}

void SeriesCsv::refuse_new(const std::string& name, const std::string& now) const {
  throw InputError(path() + ": was made without " + name + ", and this run has '" + now + "'; " +
                   switched_on("overwrite") + " begins anew");
}

void SeriesCsv::note(const std::string& name, const std::string& text) {
  const std::string now = head_text(text);
  unconfirmed_.erase(name);
  const auto known = find_entry(head_, name);
  if (known != head_.end()) return check_same(name, known->second, now);
  if (is_resumed_) refuse_new(name, now);
  if (!has_head_) head_.emplace_back(name, now);
}

void SeriesCsv::require_all_noted() const {
  if (unconfirmed_.empty()) return;
  const std::string& name = *unconfirmed_.begin();
  throw InputError(path() + ": was made with " + name + " '" + find_entry(head_, name)->second +
                   "', which this run has not; " + switched_on("overwrite") + " begins anew");
}

std::string SeriesCsv::fingerprint() const {
  std::string text;
  for (const auto& [name, value] : head_) text += name + ": " + value + "\n";
  return sha256_of(text);
}

/// That of the first row follows the head and the columns.
void SeriesCsv::begin_checksums() { sum_ = sum_of(fingerprint(), series_columns(compared_)); }

void SeriesCsv::add(const SeriesRow& row) {
  std::string text;
  if (!has_head_) {
    for (const auto& [name, value] : head_) text += "# " + name + ": " + value + "\n";
    text += csv_row(file_columns(row.columns()));
    file_.truncate(0);
    begin_checksums();
    has_head_ = true;
  }
  sum_ = sum_of(sum_, row.cells());
  std::vector<std::string> cells = row.cells();
  cells.push_back(sum_);
  file_.append(text + csv_row(cells));
  rows_.push_back(row);
}

}  // namespace espdiff
