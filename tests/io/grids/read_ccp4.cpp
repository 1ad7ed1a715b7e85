// read_ccp4.cpp: CCP4 and MRC maps: places, orders of axes, byte orders, kinds of values, and what is wrong.
#include "io/grids/read_ccp4.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;

namespace {

/// A map of 2 x 3 x 4 points (x, y, z) whose values are x + 10 y + 100 z, sections along `axes`.
struct MadeMap {
  std::int32_t axes[3] = {1, 2, 3};
  std::int32_t start[3] = {0, 0, 0};  ///< of columns, rows, sections
  float origin[3] = {0, 0, 0};
  std::int32_t space_group = 0, mode = 2;
  bool big_endian = false;
  float gamma = 90;

  std::string bytes() const {
    const std::int32_t n[] = {2, 3, 4};
    std::string file(1024, '\0');
    const auto put = [&](std::size_t byte, auto value) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      if (big_endian) std::reverse(raw, raw + sizeof value);
      file.replace(byte, sizeof value, raw, sizeof value);
    };
    const auto word = [&](int number, auto value) { put(static_cast<std::size_t>(4 * (number - 1)), value); };
    for (int i = 0; i < 3; ++i) {
      word(1 + i, n[axes[i] - 1]);
      word(5 + i, start[i]);
      word(8 + i, n[i]);
      word(11 + i, static_cast<float>(n[i]) * 1.5F);
      word(14 + i, i == 2 ? gamma : 90.0F);
      word(17 + i, axes[i]);
      word(50 + i, origin[i]);
    }
    word(4, mode);
    word(23, space_group);
    file.replace(208, 4, "MAP ");
    file[212] = file[213] = static_cast<char>(big_endian ? 0x11 : 0x44);
    const std::int32_t* const of = axes;
    for (int s = 0; s < n[of[2] - 1]; ++s) {
      for (int r = 0; r < n[of[1] - 1]; ++r) {
        for (int c = 0; c < n[of[0] - 1]; ++c) {
          int at[3];
          at[of[0] - 1] = c;
          at[of[1] - 1] = r;
          at[of[2] - 1] = s;
          const int value = at[0] + 10 * at[1] + 100 * at[2];
          const std::size_t byte = file.size();
          if (mode == 2) {
            file.append(4, '\0');
            put(byte, static_cast<float>(value));
          } else {
            file.append(2, '\0');
            put(byte, static_cast<std::int16_t>(value));
          }
        }
      }
    }
    return file;
  }
};

void check_places(const Grid& grid) {
  REQUIRE(grid.lattice.size == std::array<int, 3>{2, 3, 4});
  std::size_t n_wrong = 0;
  for (std::size_t p = 0; p < 24; ++p)
    n_wrong += grid.values[p] == static_cast<float>(p % 2 + 10 * (p / 2 % 3) + 100 * (p / 6)) ? 0 : 1;
  CHECK(n_wrong == 0);
}

}  // namespace

TEST_CASE("read_ccp4: values stand at their places in any order of axes, bytes and kinds") {
  for (const bool big_endian : {false, true}) {
    for (const std::int32_t mode : {1, 2, 6}) {
      MadeMap map;
      map.big_endian = big_endian;
      map.mode = mode;
      check_places(espdiff::read_ccp4("m.ccp4", map.bytes()));
      const std::int32_t turned[] = {3, 1, 2};
      std::copy(turned, turned + 3, map.axes);
      check_places(espdiff::read_ccp4("m.ccp4", map.bytes()));
    }
  }
}

TEST_CASE("read_ccp4: the place is the start in intervals, or the origin in Angstrom") {
  MadeMap map;
  map.axes[0] = 3;
  map.axes[2] = 1;
  const std::int32_t start[] = {-4, 2, 6};  // of z, y, x
  std::copy(start, start + 3, map.start);
  Grid grid = espdiff::read_ccp4("m.ccp4", map.bytes());
  CHECK(norm(grid.lattice.origin - espdiff::Vec3d{9, 3, -6}) < 1e-6);
  CHECK(norm(grid.lattice.step[2] - espdiff::Vec3d{0, 0, 1.5}) < 1e-6);
  map.origin[1] = 12.5F;
  grid = espdiff::read_ccp4("m.ccp4", map.bytes());
  CHECK(norm(grid.lattice.origin - espdiff::Vec3d{0, 12.5, 0}) < 1e-6);
}

TEST_CASE("read_ccp4: a whole crystal cell is periodic, and cells may be skewed") {
  MadeMap map;
  CHECK(!espdiff::read_ccp4("m.ccp4", map.bytes()).periodic);
  map.space_group = 1;
  map.gamma = 120;
  const Grid grid = espdiff::read_ccp4("m.ccp4", map.bytes());
  CHECK(grid.periodic);
  CHECK(norm(grid.lattice.step[1] - espdiff::Vec3d{-0.75, 1.5 * std::sqrt(0.75), 0}) < 1e-5);
}

TEST_CASE("read_ccp4: what is wrong is said with the file") {
  const auto refused = [](MadeMap map, std::size_t keep = 1 << 20) {
    return message_of([&] { espdiff::read_ccp4("m.ccp4", map.bytes().substr(0, keep)); });
  };
  MadeMap map;
  CHECK(refused(map, 500) == "m.ccp4: it ends within the header of a CCP4 map");
  CHECK(
      refused(map, 1100) ==
      "m.ccp4: the header promises 24 values, but only 76 bytes follow; the file is cut short or its counts are wrong");
  map.mode = 4;
  CHECK(refused(map) ==
        "m.ccp4: its values are of mode 4, and 0, 1, 2 and 6 are read; save it with 32-bit floats (mode 2)");
  map = {};
  map.axes[0] = 2;
  CHECK(refused(map) == "m.ccp4: its axes (words 17 to 19) are not 1, 2 and 3 in some order");
  map = {};
  map.gamma = 0;
  CHECK(refused(map) == "m.ccp4: its unit cell has no volume");
}

TEST_CASE("read_grid: takes CCP4 files by their content") {
  const ScratchFolder folder;
  check_places(espdiff::read_grid(folder.write("density.map", MadeMap().bytes())));
  const auto path = real_input("map_ngl/3pqr-mode0.ccp4");
  if (!path) return;
  const Grid grid = espdiff::read_grid(*path);
  CHECK(grid.values.size() == grid.lattice.n_points());
  const auto [low, high] = std::minmax_element(grid.values.begin(), grid.values.end());
  CHECK(*low >= -128);
  CHECK(*high <= 127);
  CHECK(*low < *high);
}
