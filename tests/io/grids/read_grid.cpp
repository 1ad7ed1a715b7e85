// read_grid.cpp: map files by content, and files that are no map.
#include "io/grids/read_grid.h"

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

const std::string kDx =
    "object 1 class gridpositions counts 2 2 2\norigin 0 0 0\ndelta 1 0 0\ndelta 0 1 0\ndelta 0 0 1\n"
    "object 3 class array type double rank 0 items 8 data follows\n1 2 3 4 5 6 7 8\n";

}  // namespace

TEST_CASE("read_grid: the name does not matter") {
  const ScratchFolder scratch;
  CHECK(read_grid(scratch.write("map.cube", kDx)).values == std::vector<float>{1, 5, 3, 7, 2, 6, 4, 8});
}

TEST_CASE("read_grid: a unit that is not the file's is taken, and the file's is kept for a warning") {
  const ScratchFolder scratch;
  const std::string silent = scratch.write("a.dx", kDx),
                    telling = scratch.write("b.dx", "# POTENTIAL (kT/e)\n" + std::string(kDx));
  const auto read = [](const std::string& path, const std::string& unit) {
    GridOptions options;
    options.unit = unit;
    return read_grid(path, options);
  };
  CHECK(read(silent, "mV").unit == PotentialUnit::kMillivolt);
  CHECK(read(silent, "mV").contradicting_title.empty());
  CHECK(read(telling, "mV").unit == PotentialUnit::kMillivolt);
  CHECK(read(telling, "mV").contradicting_title == "potential (kT/e)");
  CHECK(read(telling, "kT/e").contradicting_title.empty());
}

TEST_CASE("read_grid: other formats are refused by name, with a remedy") {
  const std::pair<const char*, const char*> files[] = {
      {"tim/2YPI.pdb", "a PDB or PQR structure, which is not read as a map; give an OpenDX, cube, CCP4 or VTI file"},
      {"calb/1TCA.pdb", "an mmCIF file, which is not read as a map"},
      {"traj_adk/adk_dims.dcd", "a DCD trajectory, which is not read as a map"},
      {"tim/dTIM_seq.csv",
       "a text file of unknown format, which is not read as a map; give an OpenDX, cube, CCP4 or VTI file"}};
  for (const auto& [name, part] : files) {
    const auto path = real_input(name);
    if (!path) return;
    CHECK_THROWS_AS(read_grid(*path), InputError);
    CHECK(message_of([&] { read_grid(*path); }).find(*path + ": this looks like " + part) == 0);
  }
}

TEST_CASE("read_grid: missing, directory, empty; an array name where there are none") {
  const ScratchFolder scratch;
  CHECK_THROWS_AS(read_grid(scratch.file("absent.dx")), IoError);
  CHECK_THROWS_AS(read_grid(scratch.file("")), IoError);
  CHECK_THROWS_AS(read_grid(scratch.write("empty.dx", "")), InputError);
  const std::string path = scratch.write("a.dx", kDx);
  CHECK(message_of([&] {
          read_grid(path, {"phi", ""});
        }) == path + ": array 'phi' was asked for, but only VTI files have named arrays");
}
