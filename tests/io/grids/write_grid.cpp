// write_grid.cpp: what write_dx writes is OpenDX and reads back bit by bit.
#include "io/grids/write_grid.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

Grid small_grid() {
  Grid grid;
  grid.lattice.size = {2, 3, 4};
  grid.lattice.origin = {-1.25, 2, 1.0 / 3};
  grid.lattice.step = {Vec3d{0.5, 0, 0}, Vec3d{0.1, 0.6, 0}, Vec3d{0, -0.2, 0.7}};
  for (int i = 0; i < 24; ++i)
    grid.values.push_back(std::sin(1.0F + static_cast<float>(i)) * std::pow(10.0F, static_cast<float>(i - 12)));
  grid.unit = PotentialUnit::kKtPerE;
  return grid;
}

}  // namespace

TEST_CASE("write_grid: values come back bit by bit, axes to 12 digits, the unit too") {
  const ScratchFolder scratch;
  for (PotentialUnit unit :
       {PotentialUnit::kKtPerE, PotentialUnit::kUnknown, PotentialUnit::kKcalPerMolE, PotentialUnit::kVolt}) {
    Grid grid = small_grid();
    grid.unit = unit;
    write_dx(scratch.file("a.dx"), grid);
    const Grid back = read_grid(scratch.file("a.dx"));
    CHECK(back.values == grid.values);
    CHECK(back.lattice.size == grid.lattice.size);
    CHECK(norm(back.lattice.origin - grid.lattice.origin) < 1e-11);
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(norm(back.lattice.step[axis] - grid.lattice.step[axis]) < 1e-12);
    CHECK(back.unit == unit);
  }
  CHECK(scratch.n_files() == 1);
}

TEST_CASE("write_grid: the text, z fastest") {
  const ScratchFolder scratch;
  Grid grid;
  grid.lattice.size = {2, 2, 2};
  grid.lattice.step = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  grid.values = {0, 100, 10, 110, 1, 101, 11, 0.1F};
  grid.unit = PotentialUnit::kKtPerE;
  write_dx(scratch.file("a.dx"), grid);
  CHECK(
      read_file(scratch.file("a.dx")) ==
      "# written by espdiff\n# POTENTIAL (kT/e)\nobject 1 class gridpositions counts 2 2 2\norigin 0 0 0\ndelta 1 0 0\n"
      "delta 0 1 0\ndelta 0 0 1\nobject 2 class gridconnections counts 2 2 2\n"
      "object 3 class array type double rank 0 items 8 data follows\n0 1 10\n11 100 101\n110 0.100000001\n"
      "attribute \"dep\" string \"positions\"\nobject \"regular positions regular connections\" class field\n"
      "component \"positions\" value 1\ncomponent \"connections\" value 2\ncomponent \"data\" value 3\n");
}

TEST_CASE("write_grid: nothing is written for a grid that cannot be right, or to nowhere") {
  const ScratchFolder scratch;
  Grid grid = small_grid();
  grid.values[5] = std::numeric_limits<float>::quiet_NaN();
  CHECK(message_of([&] { write_dx(scratch.file("a.dx"), grid); }) ==
        scratch.file("a.dx") + ": not written: value 5 of the map is not a finite number");
  grid = small_grid();
  grid.values.pop_back();
  CHECK(message_of([&] { write_dx(scratch.file("a.dx"), grid); }) ==
        scratch.file("a.dx") + ": not written: the grid has 24 points but 23 values");
  CHECK(scratch.n_files() == 0);
  CHECK_THROWS_AS(write_dx(scratch.file("absent/a.dx"), small_grid()), IoError);
}
