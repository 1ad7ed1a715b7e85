// read_dx.cpp: OpenDX maps, real ones and every way to be broken.
#include "io/grids/read_dx.h"

#include "base/error.h"
#include "io/grids/read_grid.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

const std::string kHeader =
    "object 1 class gridpositions counts 2 3 4\norigin 1 2 3\ndelta 0.5 0 0\ndelta 0 0.6 0\ndelta 0 0 0.7\n"
    "object 2 class gridconnections counts 2 3 4\nobject 3 class array type double rank 0 items 24 data follows\n";
const std::string kTrailer =
    "attribute \"dep\" string \"positions\"\nobject \"regular positions regular connections\" class field\n"
    "component \"positions\" value 1\ncomponent \"connections\" value 2\ncomponent \"data\" value 3\n";

/// 100 i + 10 j + k at point (i, j, k), z fastest.
std::string values(int n = 24) {
  std::string text;
  for (int index = 0; index < n; ++index) {
    text += std::to_string(100 * (index / 12) + 10 * (index / 4 % 3) + index % 4) + (index % 3 == 2 ? "\n" : " ");
  }
  return text;
}

void check_values(const Grid& grid) {
  REQUIRE(grid.values.size() == 24);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 4; ++k)
        CHECK(grid.values[static_cast<std::size_t>(i + 2 * (j + 3 * k))] == 100.0F * i + 10.0F * j + k);
    }
  }
}

std::string dx_error(const std::string& text) {
  return message_of([&] { read_dx("f.dx", text); });
}

}  // namespace

TEST_CASE("read_dx: lattice, values from z-fastest to x-fastest") {
  const Grid grid = read_dx("f.dx", kHeader + values() + kTrailer);
  CHECK(grid.lattice.size == std::array<int, 3>{2, 3, 4});
  CHECK(grid.lattice.origin == Vec3d{1, 2, 3});
  CHECK(grid.lattice.step[0] == Vec3d{0.5, 0, 0});
  CHECK(grid.lattice.step[1] == Vec3d{0, 0.6, 0});
  CHECK(grid.lattice.step[2] == Vec3d{0, 0, 0.7});
  CHECK(grid.unit == PotentialUnit::kUnknown);
  CHECK(grid.name == "f.dx");
  check_values(grid);
}

TEST_CASE("read_dx: skewed axes are kept") {
  const Grid grid = read_dx("f.dx", replaced(kHeader, "delta 0 0.6 0", "delta 0.1 0.6 -0.2") + values());
  CHECK(grid.lattice.step[1] == Vec3d{0.1, 0.6, -0.2});
}

TEST_CASE("read_dx: flavours") {
  check_values(read_dx("f", kHeader + values()));            // nothing after the values
  check_values(read_dx("f", kHeader + values(23) + "123"));  // no newline at the end
  check_values(read_dx("f", replaced(kHeader, "data follows", "follows") + values()));
  check_values(read_dx("f", "# c\n#POTENTIAL\n\n" + replaced(kHeader, "delta 0 0.6", "# between\ndelta 0 0.6") +
                                values() + "\n# end\nend\n"));
  check_values(read_dx(
      "f",
      replaced(kHeader, "type double rank 0", "type float rank 1 shape 1").replace(0, 6, "OBJECT").replace(0, 0, "") +
          values()));
  std::string dos;
  for (char c : kHeader + values() + kTrailer) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  check_values(read_dx("f", dos));
}

TEST_CASE("read_dx: words separated by other blanks and line ends") {
  std::string tabs, lines;
  for (const char c : kHeader) tabs += c == ' ' ? std::string("\t  ") : std::string(1, c);
  check_values(read_dx("f", tabs + values()));
  lines = replaced(replaced(kHeader, "class gridpositions", "class\n  gridpositions"), "rank 0", "\nrank\n0");
  check_values(read_dx("f", lines + values()));
  lines = replaced(kHeader, "data follows", "\ndata\nfollows");
  check_values(read_dx("f", lines + values()));
  check_values(read_dx("f", replaced(kHeader, "origin ", "  origin\t") + values()));
}

TEST_CASE("read_dx: the unit from APBS' comment, PMEPot's comment or field name, or none") {
  const auto unit = [](const std::string& before, const std::string& after = {}) {
    return read_dx("f", before + kHeader + values() + after).unit;
  };
  CHECK(unit("# Data from APBS 3.4.1\n# \n# POTENTIAL (kT/e)\n# \n") == PotentialUnit::kKtPerE);
  CHECK(unit("# PME potential (kT/e, T=300K)\n") == PotentialUnit::kKtPerE);
  CHECK(unit("", "\nobject \"PME potential (kT/e, T=300K)\" class field\n") == PotentialUnit::kKtPerE);
  CHECK(unit("# potential (kcal/(mol e))\n") == PotentialUnit::kKcalPerMolE);
  CHECK(unit("# Potential (mV)\n") == PotentialUnit::kMillivolt);
  CHECK(unit("# CHARGE DENSITY (e/A^3)\n") == PotentialUnit::kUnknown);
  CHECK(unit("# potential (furlongs)\n") == PotentialUnit::kUnknown);
  CHECK(unit("# potential (\n") == PotentialUnit::kUnknown);
}

TEST_CASE("read_dx: a title of another quantity is kept, in the words of APBS, VMD and others") {
  const auto title = [](const std::string& before, const std::string& after = {}) {
    return read_dx("f", before + kHeader + values() + after).contradicting_title;
  };
  CHECK(title("# CHARGE DENSITY (e/A^3)\n") == "CHARGE DENSITY (e/A^3)");
  CHECK(title("# CHARGE DISTRIBUTION (e)\n") == "CHARGE DISTRIBUTION (e)");
  CHECK(title("# LAPLACIAN OF POTENTIAL (kT/e/A^2)\n") == "LAPLACIAN OF POTENTIAL (kT/e/A^2)");
  CHECK(title("# X-SHIFTED DIELECTRIC MAP\n") == "X-SHIFTED DIELECTRIC MAP");
  CHECK(title("", "\nobject \"occupancy (protein)\" class field\n") == "object \"occupancy (protein)\" class field");
  CHECK(title("# Electrostatic pot from Total SCF Density\n").empty());
  CHECK(title("# POTENTIAL (kT/e)\n# at a distance of 5 A\n").empty());
  CHECK(title("# Comment\n").empty());
}

TEST_CASE("read_dx: fewer or more values than promised, and what is no number") {
  CHECK(dx_error(kHeader + values(20) + kTrailer) ==
        "f.dx:14: only 20 values were found, but 'items' promises 24; is the file cut short?");
  CHECK(dx_error(kHeader + values(23)) ==
        "f.dx:15: only 23 values were found, but 'items' promises 24; is the file cut short?");
  CHECK(dx_error(kHeader + values() + "7 8 9\n" + kTrailer) ==
        "f.dx:16: more values than the 24 that 'items' promises, the first '7'; correct the counts or the values");
  CHECK(dx_error(kHeader + replaced(values(), "100 ", "nan "))
            .find("f.dx:12: value 13 is 'nan'; a finite number was expected") == 0);
  CHECK(dx_error(kHeader + replaced(values(), "100 ", "inf ")).find("f.dx:12: value 13 is 'inf'") == 0);
  CHECK(dx_error(kHeader + replaced(values(), "100 ", "1e39 ")).find("f.dx:12: value 13 is '1e39'") == 0);
  CHECK(dx_error(kHeader + replaced(values(), "100 ", "1.0.0 ")).find("f.dx:12: value 13 is '1.0.0'") == 0);
}

TEST_CASE("read_dx: a header that promises more than the file holds does not allocate") {
  const std::string huge =
      replaced(replaced(kHeader, "counts 2 3 4", "counts 1000 1000 1000"), "items 24", "items 1000000000");
  CHECK(dx_error(huge + values()) == "f.dx:7: the header promises 1000000000 values, but only " +
                                         std::to_string(values().size() + 0) +
                                         " bytes follow; the file is cut short or its counts are wrong");
  const std::string absurd = replaced(kHeader, "counts 2 3 4", "counts 10000 10000 10000");
  CHECK(dx_error(absurd + values()) ==
        "f.dx:1: the grid has 10000 x 10000 x 10000 points; at most 2^31 - 1 can be read; crop or coarsen it");
  CHECK_THROWS_AS(read_dx("f", replaced(kHeader, "counts 2 3 4", "counts 9223372036854775807 2 2") + values()),
                  FormatError);
}

TEST_CASE("read_dx: counts and axes") {
  CHECK(dx_error(replaced(kHeader, "counts 2 3 4", "counts 2 0 4")) ==
        "f.dx:1: the grid has 2 x 0 x 4 points; at least 2 along each axis were expected");
  CHECK(dx_error(replaced(kHeader, "counts 2 3 4", "counts 2 -3 4")).find("f.dx:1: the grid has 2 x -3 x 4 points") ==
        0);
  CHECK(dx_error(replaced(kHeader, "counts 2 3 4", "counts 2 3")) ==
        "f.dx:1: gridpositions without three counts; 'counts nx ny nz' was expected");
  CHECK(dx_error(replaced(kHeader, "counts 2 3 4", "counts 2 3 x")).find("f.dx:1: a grid count is 'x'") == 0);
  CHECK(dx_error(replaced(kHeader, "items 24", "items 25") + values()) ==
        "f.dx:7: the array has '25' items, but the grid has 24 points; the numbers must be equal");
  CHECK(dx_error(replaced(kHeader, "delta 0 0 0.7", "delta 0 0 0") + values()) ==
        "f.dx:7: a grid step is zero; the three axes must have a length");
  CHECK(dx_error(replaced(kHeader, "delta 0 0 0.7", "delta 1 1 0") + values()) ==
        "f.dx:7: the three grid axes lie in one plane; they must span a volume");
  CHECK(dx_error(replaced(kHeader, "delta 0 0 0.7", "delta 0 0 x") + values()) ==
        "f.dx:5: delta is 'x'; a finite number was expected");
  CHECK(dx_error(replaced(kHeader, "delta 0 0 0.7\n", "") + values())
            .find("f.dx:6: values before the grid is complete") == 0);
  CHECK(dx_error(replaced(kHeader, "delta 0 0 0.7", "delta 0 0 1\ndelta 0 0 1") + values())
            .find("f.dx:6: a fourth delta") == 0);
}

TEST_CASE("read_dx: kinds of OpenDX file that are not read") {
  CHECK_THROWS_AS(read_dx("f", replaced(kHeader, "data follows", "lsb ieee data follows") + values()), InputError);
  CHECK(dx_error(replaced(kHeader, "data follows", "binary data follows") + values()) ==
        "f.dx:7: the OpenDX values are binary; write them as text");
  CHECK(dx_error(replaced(kHeader, "rank 0", "rank 1 shape 3") + values()).find("holds vectors (rank 1)") !=
        std::string::npos);
  CHECK(dx_error(replaced(kHeader, "data follows", "data file values.bin,0") + values()).find("not in this file") !=
        std::string::npos);
  CHECK(dx_error(replaced(kHeader, "class gridpositions", "class productarray") + values())
            .find("class 'productarray'") != std::string::npos);
  CHECK(dx_error("object 1 class gridpositions counts 2 2 2\n") ==
        "f.dx:1: the file ends before its values; 'object 3 class array ...' was expected");
  CHECK(dx_error("object 1 class gridpositions counts 2 2 2\nfoo 1\n") ==
        "f.dx:2: OpenDX header has 'foo'; object, origin, delta or a comment was expected");
}

TEST_CASE("read_dx: APBS' map, values picked from the file") {
  const auto path = real_input("pair_tim_maps/scTIM_chainA_pot-PE0.dx");
  if (!path) return;
  const Grid grid = read_grid(*path);
  CHECK(grid.lattice.size == std::array<int, 3>{65, 65, 65});
  CHECK(grid.lattice.origin == Vec3d{52.232, 7.2525, 28.8975});
  CHECK(grid.lattice.step[2] == Vec3d{0, 0, 0.9591406});
  CHECK(grid.unit == PotentialUnit::kKtPerE);
  // python3: v = open(f).read().split('follows')[1].split('attribute')[0].split(); v[k+65*(j+65*i)], sum(map(float, v))
  const auto value = [&](int i, int j, int k) { return grid.values[static_cast<std::size_t>(i + 65 * (j + 65 * k))]; };
  CHECK(value(0, 0, 1) == 6.137780e-03F);
  CHECK(value(0, 1, 0) == 6.245001e-03F);
  CHECK(value(1, 0, 0) == 6.767987e-03F);
  CHECK(value(32, 20, 40) == -6.771961e-01F);
  CHECK(value(64, 64, 64) == -2.073637e-03F);
  double sum = 0;
  for (float v : grid.values) sum += static_cast<double>(v);
  CHECK(sum == doctest::Approx(-150354.7893655942).epsilon(1e-8));
}

TEST_CASE("read_dx: a map without trailer") {
  const auto path = real_input("map_ngl/esp.dx");
  if (!path) return;
  const Grid grid = read_grid(*path);
  CHECK(grid.lattice.size == std::array<int, 3>{57, 52, 26});
  CHECK(grid.lattice.step[0].x == 0.257037);
  CHECK(grid.values[28 + 57 * (26 + 52 * 13)] == 1.30561F);  // as above, with v[k+26*(j+52*i)]
  CHECK(grid.values[10 + 57 * (20 + 52 * 5)] == 0.00258048F);
}

TEST_CASE("the unit alone, from a file's first lines") {
  const ScratchFolder folder;
  CHECK(potential_unit_of_file(folder.write("a.dx", "# POTENTIAL (kT/e)\nobject 1\n")) == PotentialUnit::kKtPerE);
  CHECK(potential_unit_of_file(folder.write("b.dx", "# x\n# PME potential (kT/e, T=300K)\n")) ==
        PotentialUnit::kKtPerE);
  CHECK(potential_unit_of_file(folder.write("c.dx", std::string(100000, '1'))) == PotentialUnit::kUnknown);
  CHECK(potential_unit_of_file(folder.file("absent")) == PotentialUnit::kUnknown);
}
