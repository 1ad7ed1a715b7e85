// frame_files.cpp: DCD trajectories that were cut off, or have a frame that cannot be, whoever reads them.
#include "frames/frame_files.h"

#include <array>
#include <limits>

#include "base/error.h"
#include "frames/frame_range.h"
#include "io/frames/made_dcd.h"
#include "io/structures/coordinate_file.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A reader that finds `n_frames`, of which the second has the given x.
class MadeFrames : public CoordinateFile {
 public:
  MadeFrames(std::string path, int n_frames, float x) : path_(std::move(path)), n_frames_(n_frames), x_(x) {}
  const std::string& path() const override { return path_; }
  int n_frames() const override { return n_frames_; }
  const CoordinateFrame& frame(int number) override {
    frame_.positions = {{number == 1 ? x_ : 0, 0, 0}, {1, 1, 1}};
    return frame_;
  }

 private:
  std::string path_;
  int n_frames_;
  float x_;
  CoordinateFrame frame_;
};

OpenStructure reader_of(int n_frames, float x = 0) {
  return [=](const std::string& path) {
    auto atoms = std::make_shared<Molecule>();
    atoms->residues = {{"ALA", "A", 1, ' '}};
    for (int i = 0; i < 2; ++i) {
      atoms->atoms.push_back({});
      atoms->positions.emplace_back();
      atoms->radii.push_back(1.5F);
    }
    return std::make_unique<StructureFile>(std::make_unique<MadeFrames>(path, n_frames, x), atoms);
  };
}

std::string dcd(int n_frames, int n_promised) {
  DcdForm form;
  form.n_promised = n_promised;
  const std::array<std::vector<float>, 3> frame = {std::vector<float>{0, 1}, {0, 1}, {0, 1}};
  return made_dcd(std::vector(static_cast<std::size_t>(n_frames), frame), form);
}

}  // namespace

TEST_SUITE_BEGIN("trajectory");

TEST_CASE("a DCD that lacks frames is taken only as far as its last frame is named by number") {
  const ScratchFolder folder;
  const std::string path = folder.write("a.dcd", dcd(4, 5)), whole = folder.write("b.dcd", dcd(2, 2));
  const FrameFiles files({whole, path}, [](const std::string& name) {
    return reader_of(name.back() == 'd' && name[name.size() - 5] == 'a' ? 4 : 2)(name);
  });
  CHECK(files.n_frames() == 6);
  CHECK(files.incomplete() ==
        path + " holds 4 of the 5 frames that its head promises: it is cut off, or its run ended early");
  FrameSet set;
  set.n_frames = files.n_frames();
  set.incomplete = files.incomplete();
  for (const char* open_end : {"all", "0:end", "-1", "0:2:last"})
    CHECK(message_of([&] { parse_frames(open_end, set); }) ==
          std::string("frames '") + open_end + "': " + files.incomplete() +
              "; to take the whole frames, name the last one by its number, as in 0:5");
  CHECK(parse_frames("0:5", set).size() == 6);
  CHECK(parse_frames("first,3", set) == std::vector<int>{0, 3});
  CHECK(FrameFiles({whole}, reader_of(2)).incomplete().empty());
}

TEST_CASE("a reader that finds frames that a DCD has no room for is not believed") {
  const ScratchFolder folder;
  const std::string path = folder.write("a.dcd", dcd(3, 3));
  CHECK(message_of([&] { FrameFiles({path}, reader_of(4)); }) ==
        path + ": has 3 whole frames by its size, and its reader finds 4; copy or write the file again");
}

TEST_CASE("an XTC whose last frame was cut off is as incomplete as such a DCD") {
  const ScratchFolder folder;
  std::string frame(80, '\0');  // of two atoms
  frame.replace(2, 2, "\x07\xcb").replace(7, 1, "\x02").replace(55, 1, "\x02");
  const std::string whole = frame + frame + frame;
  const std::string path = folder.write("a.xtc", whole.substr(0, 200));
  CHECK(FrameFiles({path}, reader_of(2)).incomplete() == path + " is cut off in frame 2 (40 bytes of it are there)");
  CHECK(message_of([&] { FrameFiles({path}, reader_of(3)); }) ==
        path + ": has 2 whole frames by its size, and its reader finds 3; copy or write the file again");
  CHECK(FrameFiles({folder.write("b.xtc", whole)}, reader_of(3)).incomplete().empty());
}

TEST_CASE("coordinates that cannot be are the error of their frame") {
  const ScratchFolder folder;
  const std::string path = folder.write("a.xtc", "read by nobody");
  for (const float x : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 2e6F}) {
    FrameFiles files({path}, reader_of(3, x));
    CHECK(message_of([&] { files.read(1, {}); }).rfind(path + ": frame 1: atom 0 is at (", 0) == 0);
    CHECK(message_of([&] { files.read(1, {}); }).find("coordinates are numbers within 10^6 A") != std::string::npos);
    CHECK(files.read(0, {}).size() == 2);
    CHECK(files.read(2, {}).size() == 2);
  }
  FrameFiles files({path}, reader_of(3, 9e5F));
  CHECK(files.read(1, {}).size() == 2);
}

TEST_SUITE_END();
