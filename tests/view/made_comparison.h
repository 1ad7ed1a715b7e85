// made_comparison.h: a small pair of molecules with maps of known potential, compared by the built command line.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "cli/run_espdiff.h"
#include "io/grids/write_grid.h"

namespace espdiff_test {

struct PointCharge {
  espdiff::Vec3d position;
  double charge;
};

/// Potentials of smeared charges on a lattice with skewed axes of unequal spacing.
inline espdiff::Grid map_of(const std::vector<PointCharge>& charges) {
  espdiff::Grid map;
  map.lattice.size = {33, 27, 24};
  map.lattice.origin = {-14, -13, -12};
  map.lattice.step = {espdiff::Vec3d{1.5, 0.1, 0}, espdiff::Vec3d{-0.2, 1.1, 0.05}, espdiff::Vec3d{0.1, 0, 1.05}};
  map.unit = espdiff::PotentialUnit::kKtPerE;
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 27; ++j) {
      for (int i = 0; i < 33; ++i) {
        const auto& [a, b, c] = map.lattice.step;
        const espdiff::Vec3d p =
            map.lattice.origin + static_cast<double>(i) * a + static_cast<double>(j) * b + static_cast<double>(k) * c;
        double value = 0;
        for (const PointCharge& charge : charges) value += 30 * charge.charge / (1 + norm(p - charge.position));
        map.values.push_back(static_cast<float>(value));
      }
    }
  }
  return map;
}

/// Seven bonded atoms in a row; `bend` lifts the last three.
inline std::string bent_row(double bend) {
  std::string text;
  for (int i = 0; i < 7; ++i) {
    char line[128];
    const double x = 1.4 * i, y = 0.6 * (i % 2), z = i > 3 ? bend * (i - 3) : 0.0;
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", i + 1, i + 1, x, y, z,
                  i % 2 == 0 ? 0.4 : -0.4, 2.0);
    text += line;
  }
  return text;
}

/// Compares them and writes pair.vtp and pair.json to the folder. @returns the path of pair.vtp
inline std::string compare_made_pair(const ScratchFolder& scratch, const std::string& more = "") {
  scratch.write("source.pqr", bent_row(0));
  scratch.write("target.pqr", bent_row(0.6));
  espdiff::write_dx(scratch.file("source.dx"), map_of({{{2, 4, 1}, 1}, {{7, -4, 0}, -1}}));
  espdiff::write_dx(scratch.file("target.dx"), map_of({{{3, 4, 1}, 1}, {{7, -4, 2}, -1}}));
  const Outcome run = run_espdiff("compare " + scratch.file("source.pqr") + " " + scratch.file("target.pqr") +
                                  " --quiet -o " + scratch.file("pair") + " --source-map " + scratch.file("source.dx") +
                                  " --target-map " + scratch.file("target.dx") + " " + more);
  INFO(run.err);
  REQUIRE(run.status == 0);
  return scratch.file("pair.vtp");
}

}  // namespace espdiff_test
