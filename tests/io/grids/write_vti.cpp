// write_vti.cpp: what write_vti writes is read back by VTK, bit by bit, on skewed axes too.
#include <cmath>

#include "base/error.h"
#include "io/files/atomic_file.h"
#include "io/grids/read_grid.h"
#include "io/grids/write_grid.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

Grid skewed_grid() {
  Grid grid;
  grid.lattice.size = {4, 3, 5};
  grid.lattice.origin = {-1.25, 2, 1.0 / 3};
  grid.lattice.step = {Vec3d{0.5, 0.01, 0}, Vec3d{0.1, 0.6, 0}, Vec3d{0, -0.2, 0.7}};
  for (int i = 0; i < 60; ++i)
    grid.values.push_back(std::sin(1.0F + static_cast<float>(i)) * std::pow(10.0F, static_cast<float>(i % 24 - 12)));
  grid.unit = PotentialUnit::kKtPerE;
  return grid;
}

}  // namespace

TEST_CASE("write_vti: values come back bit by bit, axes to the last digits") {
  const ScratchFolder scratch;
  const Grid grid = skewed_grid();
  write_vti(scratch.file("a.vti"), grid);
  const Grid back = read_grid(scratch.file("a.vti"));
  CHECK(back.values == grid.values);
  CHECK(back.lattice.size == grid.lattice.size);
  CHECK(back.lattice.origin == grid.lattice.origin);
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(norm(back.lattice.step[axis] - grid.lattice.step[axis]) < 1e-15);
  CHECK(back.unit == grid.unit);
}

TEST_CASE("write_map: the ending decides the format; nothing appears before it is committed") {
  const ScratchFolder scratch;
  const Grid grid = skewed_grid();
  {
    AtomicFile dx(scratch.file("a.dx")), vti(scratch.file("a.vti"));
    write_map(dx, grid);
    write_map(vti, grid);
    CHECK_FALSE(std::filesystem::exists(scratch.file("a.dx")));
    commit_all({&dx, &vti});
  }
  CHECK(read_grid(scratch.file("a.dx")).values == grid.values);
  CHECK(read_file(scratch.file("a.vti")).find("<VTKFile type=\"ImageData\"") != std::string::npos);
  CHECK(scratch.n_files() == 2);
  CHECK(message_of([] { check_map_ending("map.ccp4"); }) ==
        "map.ccp4: maps are written as OpenDX or VTI; give a name that ends in .dx or .vti");
}
