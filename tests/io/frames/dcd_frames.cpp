// dcd_frames.cpp: the frames of every layout, in any order; files of other molecules, and damaged ones.
#include "io/frames/dcd_frames.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "base/error.h"
#include "io/frames/made_dcd.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

using DcdAxes = std::array<std::vector<float>, 3>;

/// Frame f has f added to each coordinate.
std::vector<DcdAxes> shifted_frames(int n) {
  std::vector<DcdAxes> frames;
  for (int f = 0; f < n; ++f) {
    DcdAxes axes;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 4; ++i) axes[static_cast<std::size_t>(axis)].push_back(static_cast<float>(10 * axis + i + f));
    }
    frames.push_back(axes);
  }
  return frames;
}

std::string refused_dcd(const std::string& path, std::size_t n_atoms) {
  try {
    DcdFrames(path, n_atoms).frame(0);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("DcdFrames: every layout gives the places that were written, going back too") {
  const ScratchFolder folder;
  for (int i = 0; i < 32; ++i) {
    const DcdForm form{(i & 1) != 0, (i & 2) != 0, (i & 4) != 0, (i & 8) != 0, (i & 16) != 0 ? 3 : 0, -1};
    DcdFrames frames(folder.write("a.dcd", made_dcd(shifted_frames(3), form)), 4);
    CHECK(frames.n_frames() == 3);
    for (const int f : {0, 2, 1, 2}) {
      const CoordinateFrame& frame = frames.frame(f);
      REQUIRE(frame.positions.size() == 4);
      for (std::size_t atom = 0; atom < 4; ++atom) {
        // Of four atoms, the first one moves.
        const auto shift = static_cast<float>(form.n_fixed > 0 && atom > 0 ? 0 : f);
        CHECK(frame.positions[atom].x == static_cast<float>(atom) + shift);
        CHECK(frame.positions[atom].z == 20 + static_cast<float>(atom) + shift);
      }
      CHECK(frame.cell.has_value() == form.has_cell);
      if (form.has_cell) CHECK(frame.cell->angles.x == 90);
    }
  }
}

TEST_CASE("DcdFrames: another number of atoms, another file, a damaged frame") {
  const ScratchFolder folder;
  const std::string whole = made_dcd(shifted_frames(2));
  CHECK(contains(refused_dcd(folder.write("a.dcd", whole), 5), "a.dcd: has 4 atoms, and the structure 5"));
  CHECK(contains(refused_dcd(folder.write("b.dcd", "no trajectory"), 4), "b.dcd: this does not begin as a DCD"));
  CHECK(contains(refused_dcd(folder.file("none.dcd"), 4), "none.dcd: cannot be read"));
  if (std::filesystem::exists("/dev/null")) {
    std::filesystem::create_symlink("/dev/null", folder.file("device.dcd"));
    CHECK(contains(refused_dcd(folder.file("device.dcd"), 4), "device.dcd: is a pipe or a device"));
  }
  std::string damaged = whole;
  damaged[read_dcd_head(folder.file("a.dcd"))->begin] = 99;
  CHECK(contains(refused_dcd(folder.write("c.dcd", damaged), 4), "c.dcd: frame 0 is damaged"));
}
