// read_cube.cpp: Gaussian cube maps.
#include "io/grids/read_cube.h"

#include "base/error.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

constexpr double kBohrInAngstrom = 0.529177210903;

std::string cube(const std::string& third, const std::string& sizes, const std::string& rest) {
  std::istringstream counts(sizes);
  std::string nx, ny, nz;
  counts >> nx >> ny >> nz;
  return "title\n comment\n" + third + "\n " + nx + " 1 0 0\n " + ny + " 0 2 0\n " + nz + " 0.5 0 3\n" + rest;
}

std::string cube_error(const std::string& text) {
  return message_of([&] { read_cube("f.cube", text); });
}

const std::string kAtomLine = " 6 6.0 0 0 0\n";
const std::string kEight = "0 1 10 11\n100 101 110 111\n";  // 100 i + 10 j + k

}  // namespace

TEST_CASE("read_cube: Bohr, z fastest in the file") {
  const Grid grid = read_cube("f.cube", cube("1 1 2 3", "2 2 2", kAtomLine + kEight));
  CHECK(grid.lattice.size == std::array<int, 3>{2, 2, 2});
  CHECK(grid.lattice.origin.y == doctest::Approx(2 * kBohrInAngstrom).epsilon(1e-14));
  CHECK(grid.lattice.step[1].y == doctest::Approx(2 * kBohrInAngstrom).epsilon(1e-14));
  CHECK(grid.lattice.step[2].x == doctest::Approx(0.5 * kBohrInAngstrom).epsilon(1e-14));
  CHECK(grid.values == std::vector<float>{0, 100, 10, 110, 1, 101, 11, 111});
  CHECK(grid.unit == PotentialUnit::kUnknown);
}

TEST_CASE("read_cube: a comment that names another quantity than a potential is kept") {
  const auto title = [](const std::string& comment) {
    std::string text = cube("1 1 2 3", "2 2 2", kAtomLine + kEight);
    return read_cube("f.cube", text.replace(text.find(" comment"), 8, comment)).contradicting_title;
  };
  CHECK(title(" Electron density from Total SCF Density") == "Electron density from Total SCF Density");
  CHECK(title(" MO=HOMO, an orbital") == "MO=HOMO, an orbital");
  CHECK(title(" Electrostatic pot from Total SCF Density").empty());
  CHECK(title(" comment").empty());
}

TEST_CASE("read_cube: negative counts mean Angstrom") {
  const Grid grid = read_cube("f.cube", cube("0 1 2 3", "-2 -2 -2", kEight));
  CHECK(grid.lattice.size == std::array<int, 3>{2, 2, 2});
  CHECK(grid.lattice.origin == Vec3d{1, 2, 3});
  CHECK(grid.lattice.step[2] == Vec3d{0.5, 0, 3});
  CHECK(cube_error(cube("0 1 2 3", "-2 2 -2", kEight)) ==
        "f.cube:6: the three counts differ in sign; positive means Bohr, negative Angstrom");
}

TEST_CASE("read_cube: columns that touch, with exponents of three digits and without their letter") {
  const std::vector<float> values = {0.5F, -1e-2F, -2.5e-5F, 0, -3, 1e-3F, 1, -10};
  const std::vector<float> in_memory = {values[0], values[4], values[2], values[6],
                                        values[1], values[5], values[3], values[7]};
  // Fortran writes 1PE13.5 and, where an exponent needs three digits, no letter.
  CHECK(read_cube("f.cube", cube("1 0 0 0", "2 2 2",
                                 kAtomLine + "  5.00000E-01-1.00000E-02-2.50000E-05 1.00000-120\n"
                                             " -3.00000E+00 1.00000E-03 1.00000D+00-1.00000D+01\n"))
            .values == in_memory);
  CHECK(cube_error(cube("1 0 0 0", "2 2 2", kAtomLine + "5.0E-01x1.0E-02 0 0 0 0 0 0\n"))
            .find("f.cube:8: value 1 is '5.0E-01x1.0E-02'; a finite number was expected") == 0);
}

TEST_CASE("read_cube: of several volumes the first") {
  std::string two;
  for (int i = 0; i < 8; ++i) two += std::to_string(i) + " " + std::to_string(-i) + "\n";
  const std::vector<float> first = {0, 4, 2, 6, 1, 5, 3, 7};
  CHECK(read_cube("f", cube("-1 0 0 0", "2 2 2", kAtomLine + " 2 20\n 21\n" + two)).values == first);
  CHECK(read_cube("f", cube("1 0 0 0 2", "2 2 2", kAtomLine + two)).values == first);
  CHECK(read_cube("f", cube("-1 0 0 0 1", "2 2 2", kAtomLine + " 2 20 21\n" + two)).values == first);
}

TEST_CASE("read_cube: fewer or more values, bad values, bad headers") {
  CHECK(cube_error(cube("1 0 0 0", "2 2 2", kAtomLine + "0 1 10 11\n100 1011.5 110\n")) ==
        "f.cube:9: only 7 values were found, but the header promises 8; is the file cut short?");
  CHECK(cube_error(cube("1 0 0 0", "2 2 2", kAtomLine + kEight + "5\n")) ==
        "f.cube:10: more values than the 8 that the header promises, the first '5'");
  CHECK(cube_error(cube("1 0 0 0", "2 2 2", kAtomLine + "0 1 10 11\n100 NaN 110 111\n")) ==
        "f.cube:9: value 6 is 'NaN'; a finite number was expected");
  CHECK(cube_error(cube("2 0 0 0", "2 2 2", kAtomLine + kEight))
            .find("f.cube:8: atom 2 of 2 does not have five numbers") == 0);
  CHECK(cube_error(cube("1 0 0 x", "2 2 2", kEight)).find("f.cube:3: cube header without number of atoms and origin") ==
        0);
  CHECK(cube_error(cube("1 0 0 0", "2 1 2", kEight)).find("f.cube:6: the grid has 2 x 1 x 2 points; at least 2") == 0);
  CHECK(cube_error(cube("-1 0 0 0", "2 2 2", kAtomLine + " 0\n" + kEight)).find("f.cube:8: number of orbitals is 0") ==
        0);
  CHECK(cube_error("title\ncomment\n 0 0 0 0\n 2 1 0 0\n 2 1 0 0\n 2 0 0 1\n" + kEight)
            .find("f.cube:6: the three grid axes lie in one plane") == 0);
}

TEST_CASE("read_cube: headers that promise more than the file holds do not allocate") {
  CHECK(cube_error(cube("0 0 0 0", "1000 1000 1000", kEight)) ==
        "f.cube:6: the header promises 1000000000 values, but only " + std::to_string(kEight.size()) +
            " bytes follow; the file is cut short or its counts are wrong");
  CHECK_THROWS_AS(read_cube("f", cube("0 0 0 0", "100000 100000 100000", kEight)), FormatError);
  CHECK_THROWS_AS(read_cube("f", cube("0 0 0 0 9000000000000000000", "2 2 2", kEight)), FormatError);
  CHECK_THROWS_AS(read_cube("f", cube("-9223372036854775807 0 0 0", "2 2 2", kEight)), FormatError);
}

TEST_CASE("read_cube: benzene's orbital 21") {
  const auto path = real_input("map_ngl/benzene-homo.cube");
  if (!path) return;
  const Grid grid = read_grid(*path);
  CHECK(grid.lattice.size == std::array<int, 3>{55, 55, 40});
  CHECK(grid.lattice.origin.x == doctest::Approx(-9.021977 * kBohrInAngstrom).epsilon(1e-14));
  CHECK(grid.lattice.step[0].x == doctest::Approx(0.333333 * kBohrInAngstrom).epsilon(1e-14));
  // python3: v = ' '.join(open(f).read().split('\n')[19:]).split(); v[k+40*(j+55*i)]
  const auto value = [&](int i, int j, int k) { return grid.values[static_cast<std::size_t>(i + 55 * (j + 55 * k))]; };
  CHECK(value(0, 0, 0) == 1.35128E-12F);
  CHECK(value(20, 30, 25) == 4.07859E-02F);
  CHECK(value(30, 20, 25) == -7.98697E-02F);
  CHECK(value(54, 54, 39) == 2.21241E-12F);
}
