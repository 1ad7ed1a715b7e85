// read_csv.h: tables of comma-separated values (RFC 4180) with a row of column names, as spreadsheets write them.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// A table as text. Every row has as many fields as there are columns.
struct CsvTable {
  std::string path;                            ///< for messages
  std::vector<std::string> comments;           ///< lines above the names that begin with `#`, without it
  std::vector<std::string> columns;            ///< names, in file order
  std::vector<std::vector<std::string>> rows;  ///< [row][column]
  std::vector<long> lines;                     ///< [row] line of the file, from 1

  /// The position of a column, or -1.
  int find(const std::string& column) const;
  /// @throws FormatError that lists the columns there are
  std::size_t require(const std::string& column) const;
  /// The field as a number; NaN where it is empty. @throws FormatError
  double number(std::size_t row, std::size_t column) const;
};

/// Reads a file. Lines that begin with `#` before a row and empty lines are left out; fields are separated by commas,
/// or by tabs where the row of names has one; blanks around unquoted fields do not count; a field in quotes may hold
/// commas, line ends and doubled quotes; an apostrophe that write_csv_row() put in front is taken away. A byte-order
/// mark is skipped.
/// @throws IoError (missing, unreadable), FormatError (no columns, a name twice, rows of another length, a quote that
///         does not end)
CsvTable read_csv(const std::string& path);

/// The same of a text. @param path for messages
CsvTable parse_csv(const std::string& text, const std::string& path);

}  // namespace espdiff
