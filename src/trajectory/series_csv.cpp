// series_csv.cpp: writes and reads the head and the rows of a trajectory, under a lock.
#include "trajectory/series_csv.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "compare/options.h"
#include "io/read_csv.h"
#include "io/sha256.h"
#include "io/text_cursor.h"
#include "io/write_csv.h"

namespace espdiff {
namespace {

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

SeriesCsv::SeriesCsv(std::string path, SeriesHead head, ExistingFile existing, std::vector<std::string> parts)
    : file_(std::move(path), existing), head_(std::move(head)), parts_(std::move(parts)) {
  for (auto& entry : head_) entry.second = head_text(entry.second);
  if (existing == ExistingFile::kResume && file_.has_content()) read_rows();
}

void SeriesCsv::read_rows() {
  const std::string text = file_.text();
  const std::string lines = complete_lines(text);
  if (text.rfind(kFirstWords, 0) == 0 && has_comments_only(lines)) return;  // only a part of the head
  const CsvTable table = parse_csv(lines, path());
  SeriesHead in_file;
  for (const std::string& comment : table.comments) {
    const std::size_t colon = std::min(comment.find(':'), comment.size());
    const std::string name = comment.substr(0, colon),
                      value = colon + 2 < comment.size() ? comment.substr(colon + 2) : "";
    const auto wanted = find(head_, name);
    if (wanted != head_.end()) check_same(name, value, wanted->second);
    in_file.emplace_back(name, value);
  }
  if (table.columns != series_columns(parts_))
    throw FormatError(path(), static_cast<long>(table.comments.size()) + 1,
                      "this is not this version's line of columns; give another file");
  head_ = std::move(in_file);
  for (const auto& cells : table.rows) rows_.emplace_back(cells, parts_);
  has_head_ = true;
  file_.truncate(lines.size());
}

void SeriesCsv::check_same(const std::string& name, const std::string& in_file, const std::string& now) const {
  if (in_file == now) return;
  throw InputError(path() + ": was made with " + name + " '" + in_file + "', not with '" + now + "'; " +
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

void SeriesCsv::add(const SeriesRow& row) {
  std::string text;
  if (!has_head_) {
    for (const auto& [name, value] : head_) text += "# " + name + ": " + value + "\n";
    text += csv_row(row.columns());
    file_.truncate(0);
    has_head_ = true;
  }
  file_.append(text + csv_row(row.cells()));
  rows_.push_back(row);
}

}  // namespace espdiff
