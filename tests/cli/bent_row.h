// bent_row.h: what the tests of regions and patches share: states of a made molecule, options, cells of tables.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "io/files/read_csv.h"

namespace espdiff_test {

/// Options of a quick run.
inline const std::string kUsual = " --device cpu --pb-spacing 1 -q";

/// A row of atoms that is bent, with charges of both signs.
inline std::string bent_row(double bend, int n = 9) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    char line[128];
    const double x = 2.6 * i;
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", i + 1, i + 1, x,
                  0.9 * (i % 3) + 0.01 * bend * x * x, 0.5 * (i % 2), i % 3 == 0 ? -0.7 : 0.4, 2.1);
    text += line;
  }
  return text;
}

/// The text in a row and under a column.
inline std::string cell(const espdiff::CsvTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  REQUIRE_MESSAGE(found != table.columns.end(), column);
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

}  // namespace espdiff_test
