// read_unit_cells.cpp: CRYST1 records of models, and NAMD's .xsc files.
#include "io/structures/read_unit_cells.h"

#include <cstdio>
#include <ctime>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

const char* const kPqrAtom = "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  0.5000 2.0000\n";

std::vector<std::optional<UnitCell>> cells_of(const std::string& path) {
  const StructureFile file(path);
  std::vector<std::optional<UnitCell>> cells;
  for (int model = 1; model <= file.n_models(); ++model) cells.push_back(file.unit_cell(model));
  return cells;
}

std::string cryst1(const char* numbers) { return std::string("CRYST1") + numbers + " P 1           1\n"; }

}  // namespace

TEST_CASE("unit cells: each model has the last CRYST1 before it; none and dummies are none") {
  const ScratchFolder scratch;
  const std::string first = cryst1("   42.439   42.500   43.125 109.47  90.00  80.50"),
                    second = cryst1("   50.000   51.000   52.000  90.00  90.00  90.00"),
                    dummy = cryst1("    1.000    1.000    1.000  90.00  90.00  90.00");
  const auto cells = cells_of(
      scratch.write("a.pqr", first + kPqrAtom + "END\n" + second + kPqrAtom + "END\n" + dummy + kPqrAtom + "END\n"));
  REQUIRE(cells.size() == 3);
  REQUIRE(cells[0].has_value());
  CHECK(cells[0]->lengths == Vec3d{42.439, 42.5, 43.125});
  CHECK(cells[0]->angles == Vec3d{109.47, 90, 80.5});
  REQUIRE(cells[1].has_value());
  CHECK(cells[1]->lengths == Vec3d{50, 51, 52});
  CHECK_FALSE(cells[2].has_value());
  // One record for all models of a file.
  const auto shared =
      cells_of(scratch.write("b.pqr", second + "MODEL 1\n" + kPqrAtom + "ENDMDL\nMODEL 2\n" + kPqrAtom + "ENDMDL\n"));
  REQUIRE(shared.size() == 2);
  CHECK(shared[1].has_value());
  CHECK_FALSE(cells_of(scratch.write("c.pqr", kPqrAtom))[0].has_value());
  CHECK(message_of([&] {
          cells_of(scratch.write("d.pqr", "CRYST1   42.439\n" + std::string(kPqrAtom)));
        }).find("d.pqr:1: the CRYST1 record's length is ''") != std::string::npos);
}

TEST_CASE("unit cells: four times the frames take about four times as long, not sixteen") {
  const ScratchFolder scratch;
  const auto seconds_for = [&](int n_frames) {
    std::string text;
    for (int i = 0; i < n_frames; ++i) {
      char lengths[32];
      std::snprintf(lengths, sizeof lengths, "%9.3f", 40.0 + i % 1000);
      text += cryst1((lengths + std::string("   51.000   52.000  90.00  90.00  90.00")).c_str()) + kPqrAtom + "END\n";
    }
    const std::string path = scratch.write("many.pqr", text);
    const std::clock_t begun = std::clock();  // processor time, which other programs do not add to
    const auto cells = cells_of(path);
    const double seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    REQUIRE(cells.size() == static_cast<std::size_t>(n_frames));
    CHECK(cells[1234]->lengths.x == 40 + 234);
    CHECK(cells.back()->lengths.x == 40 + (n_frames - 1) % 1000);
    return seconds;
  };
  const double fewer = seconds_for(10000);
  CHECK(seconds_for(40000) < 8 * fewer + 0.05);
}

TEST_CASE("unit cells: a NAMD .xsc file, and one that lacks a column") {
  const ScratchFolder scratch;
  const auto cell = read_xsc(scratch.write("a.xsc",
                                           "# NAMD extended system configuration output file\n"
                                           "#$LABELS step a_x a_y a_z b_x b_y b_z c_x c_y c_z o_x o_y o_z\n"
                                           "500 40 0 0 1 41 0 2 3 42.5 -1 -2 -3.5\n"));
  CHECK(cell[0] == Vec3d{-1, -2, -3.5});
  CHECK(cell[1] == Vec3d{40, 0, 0});
  CHECK(cell[2] == Vec3d{1, 41, 0});
  CHECK(cell[3] == Vec3d{2, 3, 42.5});
  CHECK(message_of([&] {
          read_xsc(scratch.write("b.xsc", "#$LABELS step a_x\n1 40\n"));
        }).find("no value for o_x; an .xsc file has a line") != std::string::npos);
  CHECK(message_of([&] {
          read_xsc(scratch.write("c.xsc", "#$LABELS step a_x\n1 fourty\n"));
        }).find("c.xsc:2: column a_x is 'fourty'") != std::string::npos);
  CHECK_THROWS_AS(read_xsc(scratch.file("absent.xsc")), IoError);
}
