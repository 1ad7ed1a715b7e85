// bent_row.h: states of a made molecule for the tests of regions and patches.
#pragma once

#include <cstdio>
#include <string>

namespace espdiff_test {

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

}  // namespace espdiff_test
