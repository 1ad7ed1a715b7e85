// series_csv.cpp: rows of a trajectory as text, and back.
#include "trajectory/series_csv.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "compare/options.h"
#include "io/atomic_file.h"
#include "io/sha256.h"
#include "io/write_csv.h"
#include "report/metrics.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// A column, and where its value stands in OUT.json; "" where it is in none.
struct Column {
  std::string name, pointer;
};

/// The metrics of a series stand between what names the row and how it came about, those of the mapping after them;
/// the potential's unit before the first metric of potentials.
std::vector<Column> make_columns() {
  std::vector<Column> all = {{"frame", ""}, {"reference_frame", ""}}, of_mapping;
  bool has_unit = false;
  for (const Metric& metric : metrics()) {
    if ((metric.flags & kInSeries) == 0) continue;
    const bool is_of_potential = metric.section == MetricSection::kPotential;
    if (is_of_potential && !has_unit) all.push_back({"potential_unit", "/potential_unit"});
    has_unit = has_unit || is_of_potential;
    (metric.section == MetricSection::kMapping ? of_mapping : all).push_back({metric.name, metric.json_pointer()});
  }
  const auto add = [&all](const std::vector<Column>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add({{"converged", "/certificate/converged"}, {"trustworthy", "/certificate/trustworthy"}, {"start", "/start"}});
  add(of_mapping);
  add({{"time_ms", "/time_ms/total"}, {"reasons", "/certificate/reasons"}, {"error", ""}});
  return all;
}

const std::vector<Column>& columns() {
  static const std::vector<Column> all = make_columns();
  return all;
}

/// A row is a line: what is not complete can be told by its end.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_string()) return one_line(value.get<std::string>());
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& element : value) text += (text.empty() ? "" : "; ") + cell_of(element);
  return text;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::ostringstream line;
  write_csv_row(line, cells);
  return line.str();
}

/// The cells of a line; none where a quote is not closed.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      const bool is_doubled = is_quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (is_doubled) cells.back() += line[++i];
      if (!is_doubled) is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (is_quoted) cells.clear();
  return cells;
}

std::size_t index_of(const std::string& column) {
  const auto& names = series_columns();
  const auto found = std::find(names.begin(), names.end(), column);
  if (found == names.end()) throw Error(ErrorClass::kInternal, "a trajectory's rows have no column '" + column + "'");
  return static_cast<std::size_t>(found - names.begin());
}

bool has_content(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && std::filesystem::file_size(path, ignored) != 0;
}

}  // namespace

const std::vector<std::string>& series_columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Column& column : columns()) all.push_back(column.name);
    return all;
  }();
  return names;
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const Molecule& source, const Molecule& target,
                     const CompareResult& result, const CompareOptions& options) {
  const Json json = compare_json(source, target, result, options, {});
  for (const Column& column : columns())
    cells_.push_back(column.pointer.empty() ? std::string() : cell_of(json.at(Json::json_pointer(column.pointer))));
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
}

SeriesRow::SeriesRow(int frame, const std::string& reference, const std::string& error)
    : cells_(series_columns().size()) {
  at("frame") = std::to_string(frame);
  at("reference_frame") = one_line(reference);
  at("error") = one_line(error);
}

const std::string& SeriesRow::operator[](const std::string& column) const { return cells_.at(index_of(column)); }
std::string& SeriesRow::at(const std::string& column) { return cells_.at(index_of(column)); }

SeriesCsv::SeriesCsv(std::string path, SeriesHead head, ExistingFile existing)
    : path_(std::move(path)), head_(std::move(head)) {
  for (auto& entry : head_) entry.second = one_line(entry.second);
  if (!has_content(path_) || existing == ExistingFile::kReplace) {
    AtomicFile probe(path_);  // what cannot be written is better found before the first frame
    replace_ = true;
    return;
  }
  if (existing == ExistingFile::kRefuse)
    throw IoError(path_, "the file exists; " + switched_on("resume") + " goes on with it, " + switched_on("overwrite") +
                             " replaces it");
  read_rows();
}

void SeriesCsv::check_head(const std::string& name, const std::string& text) const {
  const auto found = std::find_if(head_.begin(), head_.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == head_.end() || found->second == text) return;
  throw InputError(path_ + ": was made with " + name + " '" + text + "', not with '" + found->second + "'; " +
                   switched_on("overwrite") + " begins anew");
}

void SeriesCsv::read_rows() {
  std::ifstream in(path_, std::ios::binary);
  if (!in) throw IoError(path_, "cannot be read");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  bool has_columns = false;
  std::size_t start = 0;
  long number = 1;
  // A last line without an end was being written when the run broke off.
  for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1, ++number) {
    const std::string line = text.substr(start, end - start);
    const std::size_t colon = line.find(": ");
    if (line.rfind("# ", 0) == 0 && (colon != std::string::npos || line.back() == ':')) {
      const bool has_text = colon != std::string::npos;
      check_head(line.substr(2, (has_text ? colon : line.size() - 1) - 2), has_text ? line.substr(colon + 2) : "");
    } else if (!has_columns) {
      if (line + "\n" != line_of(series_columns()))
        throw FormatError(path_, number, "this is not this version's line of columns; give another file");
      has_columns = true;
    } else {
      std::vector<std::string> cells = cells_of(line);
      if (cells.size() != series_columns().size())
        throw FormatError(path_, number,
                          "the row has " + std::to_string(cells.size()) + " columns instead of " +
                              std::to_string(series_columns().size()));
      rows_.emplace_back(std::move(cells));
    }
  }
  replace_ = !has_columns;
  if (replace_ || start == text.size()) return;
  AtomicFile shortened(path_);
  shortened.stream() << text.substr(0, start);
  shortened.commit();
}

std::string SeriesCsv::fingerprint() const {
  std::string text;
  for (const auto& [name, value] : head_) text += name + ": " + value + "\n";
  return sha256_of(text);
}

void SeriesCsv::append(const std::string& text) const {
  std::ofstream out(path_, std::ios::binary | std::ios::app);
  out << text;
  out.close();
  if (!out)
    throw IoError(path_, "cannot be written; is the disk full? " + switched_on("resume") +
                             " goes on after the last complete row");
}

void SeriesCsv::add(const SeriesRow& row) {
  if (replace_) {
    AtomicFile file(path_);
    for (const auto& [name, text] : head_) file.stream() << "# " << name << ": " << text << '\n';
    file.stream() << line_of(series_columns()) << line_of(row.cells());
    file.commit();
    replace_ = false;
  } else {
    append(line_of(row.cells()));
  }
  rows_.push_back(row);
}

}  // namespace espdiff
