// write_pdb.cpp: columns against the format's own example, numbers that do not fit, and a file that is read back.
#include "io/molecules/write_pdb.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;  // NOLINT: a test of one header
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

Molecule small() {
  Molecule m;
  m.name = "m.pqr";
  m.residues = {{"HIS", "A", 49, ' '}, {"CA", "PROT", 12345, 'B'}};
  m.atoms = {{"N", "N", 0, false}, {"HD11", "H", 0, false}, {"CA", "Ca", 1, true}};
  m.positions = {{69.668, 33.705, -4.794}, {0, 0, 0}, {-99.5, 1, 2}};
  m.radii = {1, 1, 1};
  return m;
}

std::string written(const Molecule& m, const std::vector<double>& values) {
  std::ostringstream out;
  write_pdb(out, m, values, {"one", "two"});
  return out.str();
}

}  // namespace

TEST_SUITE_BEGIN("write_pdb");

TEST_CASE("records have the columns of the format") {
  const std::string text = written(small(), {18.321, -1.5, std::numeric_limits<double>::quiet_NaN()});
  std::istringstream lines(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  REQUIRE(all.size() == 6);
  CHECK(all[0] == "REMARK  99 one");
  //               1         2         3         4         5         6         7
  //      12345678901234567890123456789012345678901234567890123456789012345678901234567890
  CHECK(all[2] == "ATOM      1  N   HIS A  49      69.668  33.705  -4.794  1.00 18.32           N");
  CHECK(all[3] == "ATOM      2 HD11 HIS A  49       0.000   0.000   0.000  1.00 -1.50           H");
  CHECK(all[4] == "HETATM    3 CA    CA P2345B    -99.500   1.000   2.000  0.00  0.00      PROTCA");
  CHECK(all[5] == "END");
}

TEST_CASE("what does not fit is refused with the atom") {
  Molecule m = small();
  CHECK(message_of([&] {
          written(m, {1000, 0, 0});
        }).find("atom N of HIS49: the value 1000 does not fit") != std::string::npos);
  CHECK(message_of([&] { written(m, {0, 0}); }).find("2 values for 3 atoms") != std::string::npos);
  m.positions[1].y = 12345;
  CHECK(message_of([&] { written(m, {0, 0, 0}); }).find("a coordinate does not fit") != std::string::npos);
}

#if defined(ESPDIFF_HAVE_GEMMI)
TEST_CASE("the file reads back as the molecule") {
  const ScratchFolder folder;
  const Molecule m = small();
  const Molecule back = read_structure(folder.write("m.pdb", written(m, {1, 2, 3})));
  REQUIRE(back.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(back.atoms[i].name == m.atoms[i].name);
    CHECK(norm(back.positions[i] - m.positions[i]) < 1e-3);
  }
  CHECK(back.atoms[2].element == "Ca");
  CHECK(back.residues[1].insertion_code == 'B');
}
#endif

TEST_SUITE_END();
