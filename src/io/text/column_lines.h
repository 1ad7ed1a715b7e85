// column_lines.h: lines of formats whose leading blanks are columns.
#pragma once

#include <algorithm>
#include <string_view>

namespace espdiff {

struct ColumnLines {
  std::string_view rest;
  long number = 0;  ///< of the line read last, from 1

  bool only_blanks_follow() const { return rest.find_first_not_of(" \t\r\n") == std::string_view::npos; }
  /// The next line, whole but for its end; empty behind the last.
  std::string_view next() {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++number;
    return line;
  }
};

}  // namespace espdiff
