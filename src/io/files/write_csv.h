// write_csv.h: rows of comma-separated values (RFC 4180).
#pragma once

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace espdiff {

/// A spreadsheet takes a cell that begins with one of these for a formula.
constexpr std::string_view kFormulaStarts = "=+-@";

/// Shortest text with up to `n_digits` significant digits; empty for NaN (no value). Independent of the locale.
std::string csv_number(double value, int n_digits = 6);

/// Writes one row; a field with a comma, a quote, a tab or a line break is quoted, and one that begins with `#` or has
/// blanks at an end. A text that a spreadsheet would compute
/// (it begins with `=`, `+`, `-` or `@`, and is no number) gets an apostrophe in front, which parse_csv() takes away.
void write_csv_row(std::ostream& out, const std::vector<std::string>& fields);

/// The same as text, with the line's end.
std::string csv_row(const std::vector<std::string>& fields);

}  // namespace espdiff
