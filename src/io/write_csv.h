// write_csv.h: rows of comma-separated values (RFC 4180).
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace espdiff {

/// Shortest text with up to `n_digits` significant digits; empty for NaN (no value). Independent of the locale.
std::string csv_number(double value, int n_digits = 6);

/// Writes one row; a field with a comma, a quote or a line break is quoted.
void write_csv_row(std::ostream& out, const std::vector<std::string>& fields);

/// The same as text, with the line's end.
std::string csv_row(const std::vector<std::string>& fields);

}  // namespace espdiff
