// amber_frames.cpp: Amber's restarts in text and NetCDF, NetCDF trajectories, and what is wrong with damaged ones.
#include "io/structures/amber_frames.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "io/files/file_kind.h"
#include "io/structures/made_amber.h"
#include "io/structures/read_topology.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

CoordinateFrame frame_of(const std::string& content, int number = 0) {
  return amber_frames({"a.rst7", content, ""})->frame(number);
}

std::string error_of(const std::string& content) {
  return message_of([&] { frame_of(content); });
}

/// Atoms C1, C2, ... of one residue.
Molecule atoms(std::size_t n) {
  Molecule molecule;
  molecule.name = "a.prmtop";
  molecule.residues.push_back({"LIG", "", 1, ' '});
  for (std::size_t i = 0; i < n; ++i) molecule.atoms.push_back({"C" + std::to_string(i + 1), "C", 0, false});
  molecule.positions.resize(n);
  molecule.radii.assign(n, 1.7F);
  return molecule;
}

}  // namespace

TEST_CASE("AmberRestart: coordinates, and the cell behind them or behind velocities") {
  CHECK(recognise(made_restart(5)) == FileKind::kAmberRestart);
  for (const int n : {1, 2, 3, 4, 5, 100}) {
    const CoordinateFrame bare = frame_of(made_restart(n));
    REQUIRE(bare.positions.size() == static_cast<std::size_t>(n));
    CHECK(bare.positions.back() == Vec3f{n - 1.0F, n - 0.5F, 1.0F - n});
    CHECK_FALSE(bare.cell.has_value());
  }
  const CoordinateFrame box = frame_of(made_restart(5, {30, 40, 50, 90, 100, 90}));
  REQUIRE(box.cell.has_value());
  CHECK(box.cell->lengths == Vec3d{30, 40, 50});
  CHECK(box.cell->angles == Vec3d{90, 100, 90});
  CHECK(frame_of(made_restart(5, {30, 40, 50})).cell->angles == Vec3d{90, 90, 90});
  std::vector<double> velocities(15, 0.25);
  CHECK_FALSE(frame_of(made_restart(5, velocities)).cell.has_value());
  velocities.insert(velocities.end(), {30, 40, 50, 90, 90, 90});
  CHECK(frame_of(made_restart(5, velocities)).cell->lengths.y == 40);
  CHECK_FALSE(frame_of(made_restart(5, {0, 0, 0, 90, 90, 90})).cell.has_value());
  std::string blank = made_restart(4);
  blank.replace(0, blank.find('\n'), "");
  CHECK(recognise(blank) == FileKind::kAmberRestart);  // LEaP leaves the title empty
}

TEST_CASE("AmberRestart: damaged files") {
  const std::string whole = made_restart(5);
  CHECK(error_of(whole.substr(0, whole.size() - 14)) ==
        "a.rst7:5: this Amber restart ends after 14 numbers, and 15 coordinates were expected, or as many velocities "
        "behind them; copy or write the file again");
  CHECK(error_of(made_restart(5, {1, 2, 3, 4})).find("ends after 19 numbers") != std::string::npos);
  CHECK(error_of(made_restart(2, std::vector<double>(40, 1))).find("has more numbers than coordinates") !=
        std::string::npos);
  std::string stars = whole;
  stars.replace(stars.find("   4.0000000"), 12, "************");
  CHECK(error_of(stars) ==
        "a.rst7:5: a number of this Amber restart is '************'; six in columns of twelve were expected: write the "
        "file again, as NetCDF if the molecule is far from the origin");
  CHECK(error_of("title\n9999999999\n" + whole.substr(whole.find("   0.0000000"))).find("at most 5000000 are read") !=
        std::string::npos);
}

TEST_CASE("AmberNetcdf: trajectories and restarts of every version") {
  for (const int version : {1, 2, 5}) {
    CAPTURE(version);
    for (const bool has_cell : {true, false}) {
      NetcdfForm form;
      form.version = version;
      form.has_cell = has_cell;
      AmberNetcdf two(bytes_of_text("a.nc", made_netcdf({{1, 2, 3}, {5, 6, 7}}, form)));
      CHECK(two.n_frames() == 2);
      CHECK(two.missing().empty());
      CHECK(two.frame(1).positions[2] == Vec3f{7, 8, 9});
      CHECK(two.frame(0).positions[0] == Vec3f{1, 2, 3});
      CHECK(two.frame(1).cell.has_value() == has_cell);
      if (has_cell) CHECK(two.frame(1).cell->angles == Vec3d{90, 100, 90});
      form.is_trajectory = false;
      AmberNetcdf restart(bytes_of_text("a.rst7", made_netcdf({{1, 2, 3}}, form)));
      CHECK(restart.n_frames() == 1);
      CHECK(restart.frame(0).positions[1] == Vec3f{2, 3, 4});
      if (has_cell) CHECK(restart.frame(0).cell->lengths == Vec3d{30, 40, 50});
    }
  }
  NetcdfForm stream;
  stream.is_stream = true;
  CHECK(AmberNetcdf(bytes_of_text("a.nc", made_netcdf({{1}, {2}, {3}}, stream))).n_frames() == 3);
  const ScratchFolder folder;
  AmberNetcdf file(bytes_of_file(folder.write("a.nc", made_netcdf({{1}, {2}}))));
  CHECK(file.frame(1).positions[0] == Vec3f{2, 3, 4});
}

TEST_CASE("AmberNetcdf: cut and foreign files") {
  const std::string whole = made_netcdf({{1, 2}, {3, 4}, {5, 6}});
  const auto error = [](const std::string& content) {
    return message_of([&] { AmberNetcdf(bytes_of_text("a.nc", content)); });
  };
  AmberNetcdf cut(bytes_of_text("a.nc", whole.substr(0, whole.size() - 30)));
  CHECK(cut.n_frames() == 2);
  CHECK(cut.missing() == "holds 2 of the 3 frames that its head promises: it is cut off");
  NetcdfForm form;
  form.n_promised = 2;  // what lies behind those that the head names is not finished
  CHECK(AmberNetcdf(bytes_of_text("a.nc", made_netcdf({{1}, {2}, {3}}, form))).n_frames() == 2);
  CHECK(error(whole.substr(0, whole.size() - 215)).find("holds no whole frame; copy or write the file again") !=
        std::string::npos);
  for (std::size_t n = 4; n < 300; n += 7) CHECK(error(whole.substr(0, n)).find("a.nc") == 0);
  form = {};
  form.unit = "nanometer";
  CHECK(error(made_netcdf({{1}}, form)) == "a.nc: its coordinates have the unit 'nanometer'; Angstrom was expected");
  form = {};
  form.coordinates = "temperature";
  CHECK(error(made_netcdf({{1}}, form)).find("has no coordinates of atoms by Amber's conventions; give an Amber") !=
        std::string::npos);
  CHECK(error("CDF\x07" + whole.substr(4)).find("does not begin as a classic NetCDF file") != std::string::npos);
  std::string wrong_list = whole;
  wrong_list[11] = 9;
  CHECK(error(wrong_list).find("the head of this NetCDF file is damaged") != std::string::npos);
}

TEST_CASE("StructureFile: Amber's coordinates need the atoms of a topology") {
  const ScratchFolder folder;
  const StructureFile file(folder.write("a.inpcrd", made_restart(3, {30, 40, 50, 90, 90, 90})));
  CHECK(file.needs_atoms());
  CHECK(file.n_models() == 1);
  CHECK(file.n_atoms(1) == 3);
  CHECK(file.unit_cell(1)->lengths.x == 30);
  const std::string nameless = message_of([&] { file.read({}); });
  CHECK_MESSAGE(nameless.find("a.inpcrd: has the coordinates of 3 atoms without their names; give the topology that") !=
                    std::string::npos,
                nameless);
  const Molecule molecule = file.read_with(atoms(3), {});
  CHECK(molecule.positions[2] == Vec3d{2, 2.5, -2});
  CHECK(molecule.atoms[2].name == "C3");
  CHECK(message_of([&] {
          file.read_with(atoms(4), {});
        }).find("a.inpcrd: has 3 atoms, and a.prmtop has 4; give the topology that the coordinates were made with") !=
        std::string::npos);
  const StructureFile trajectory(folder.write("a.nc", made_netcdf({{1, 2}, {3, 4}})));
  CHECK(trajectory.n_models() == 2);
  CHECK(trajectory.read_with(atoms(2), {2, true, true, {}}).positions[0] == Vec3d{3, 4, 5});
  CHECK_FALSE(StructureFile(folder.write("a.gro", "one\n1\n    1LIG     C1    1   0.100   0.200   0.300\n 1 1 1\n"))
                  .needs_atoms());
}
