// write_csv.cpp: numbers and fields as text.
#include "io/files/write_csv.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "io/text/text_cursor.h"

namespace espdiff {
namespace {

bool is_label_like_formula(const std::string& field) {
  double ignored = 0;
  return !field.empty() && kFormulaStarts.find(field[0]) != std::string_view::npos && !parse_number(field, ignored) &&
         field != "-inf";
}

/// Whether parse_csv() would read another text: fields are separated, and blanks and comments are passed over.
bool is_read_otherwise(const std::string& field) {
  if (field.empty()) return false;
  return field[0] == '#' || trimmed(field) != field || field.find_first_of(",\"\r\n\t") != std::string::npos;
}

std::string quoted(const std::string& field) {
  const bool is_formula = is_label_like_formula(field);
  if (!is_formula && !is_read_otherwise(field)) return field;
  std::string result = is_formula ? "\"'" : "\"";
  for (const char c : field) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

std::string csv_number(double value, int n_digits) {
  if (std::isnan(value)) return {};
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, n_digits).ptr;
  return {text, end};
}

void write_csv_row(std::ostream& out, const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) out << (i == 0 ? "" : ",") << quoted(fields[i]);
  out << '\n';
}

std::string csv_row(const std::vector<std::string>& fields) {
  std::ostringstream row;
  write_csv_row(row, fields);
  return row.str();
}

}  // namespace espdiff
