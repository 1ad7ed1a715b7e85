// read_csv.cpp: fields, quotes and line ends, character by character.
#include "io/files/read_csv.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/memory.h"
#include "io/files/read_input.h"
#include "io/files/write_csv.h"
#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

/// Takes rows off a text.
class CsvReader {
 public:
  CsvReader(const std::string& text, const std::string& path) : text_(text), path_(path) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
  }

  /// Moves to the next row that says something; false at the end.
  bool next_row() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::string_view line = trimmed(text_.substr(at_, end - at_));
      if (!line.empty() && line[0] != '#') return true;
      if (!line.empty()) comments_.emplace_back(trimmed(line.substr(1)));
      at_ = end + 1;
      ++line_;
    }
    return false;
  }

  void choose_separator() {
    const std::string_view line = text_.substr(at_, std::min(text_.find('\n', at_), text_.size()) - at_);
    if (line.find('\t') != std::string_view::npos) separator_ = '\t';
  }

  std::vector<std::string> row() {
    std::vector<std::string> fields;
    for (;;) {
      fields.push_back(without_mark(field()));
      if (at_ >= text_.size()) return fields;
      const char c = text_[at_++];
      if (c == separator_) continue;
      ++line_;
      return fields;
    }
  }

  long line() const { return line_; }
  /// Of the lines passed so far.
  const std::vector<std::string>& comments() const { return comments_; }

 private:
  /// Of a text that write_csv_row() kept from being a formula.
  static std::string without_mark(std::string text) {
    const bool is_marked = text.size() > 1 && text[0] == '\'' && kFormulaStarts.find(text[1]) != std::string_view::npos;
    return is_marked ? text.substr(1) : text;
  }

  std::string field() {
    std::size_t start = at_;
    while (start < text_.size() && (text_[start] == ' ' || (text_[start] == '\t' && separator_ != '\t'))) ++start;
    if (start < text_.size() && text_[start] == '"') {
      at_ = start + 1;
      return quoted();
    }
    while (at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n') ++at_;
    return std::string(trimmed(text_.substr(start, at_ > start ? at_ - start : 0)));
  }

  /// From behind the opening quote to the separator or line end behind the closing one.
  std::string quoted() {
    const long first_line = line_;
    std::string value;
    for (;; ++at_) {
      if (at_ >= text_.size()) throw FormatError(path_, first_line, "a quote is opened and never closed");
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] != '"') {
        value += text_[at_];
      } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        value += text_[at_++];
      } else {
        break;
      }
    }
    ++at_;
    while (at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n') {
      if (text_[at_] != ' ' && text_[at_] != '\r')
        throw FormatError(path_, line_, "text follows a closing quote; double the quotes inside of a field");
      ++at_;
    }
    return value;
  }

  std::string_view text_;
  const std::string& path_;
  std::vector<std::string> comments_;
  std::size_t at_ = 0;
  long line_ = 1;
  char separator_ = ',';
};

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

int CsvTable::find(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

std::size_t CsvTable::require(const std::string& column) const {
  const int found = find(column);
  if (found >= 0) return static_cast<std::size_t>(found);
  throw FormatError(path, 0, "there is no column '" + column + "'; there are: " + listed(columns));
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string& field = rows.at(row).at(column);
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  if (!parse_number(field, value))
    throw FormatError(path, lines.at(row), "column " + columns.at(column) + ": " + in_quotes(field) + " is no number");
  return value;
}

CsvTable read_csv(const std::string& path) { return parse_csv(read_text_file(path), path); }

CsvTable parse_csv(const std::string& text, const std::string& path) {
  const auto n_separators =
      std::count_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '\t' || c == '\n'; });
  require_memory(2.0 * sizeof(std::string) * static_cast<double>(n_separators), path);
  CsvTable table;
  table.path = path;
  CsvReader reader(text, path);
  if (!reader.next_row())
    throw FormatError(path, 0, "there is no row of column names; the first line that is not a comment holds them");
  reader.choose_separator();
  table.comments = reader.comments();
  const long first = reader.line();
  table.columns = reader.row();
  std::set<std::string_view> seen;
  for (const std::string& column : table.columns) {
    if (!seen.insert(column).second) throw FormatError(path, first, "the column '" + column + "' is there twice");
  }
  while (reader.next_row()) {
    table.lines.push_back(reader.line());
    table.rows.push_back(reader.row());
    if (table.rows.back().size() != table.columns.size())
      throw FormatError(path, table.lines.back(),
                        std::to_string(table.rows.back().size()) + " fields instead of " +
                            std::to_string(table.columns.size()) + " (" + listed(table.columns) + ")");
  }
  return table;
}

}  // namespace espdiff
