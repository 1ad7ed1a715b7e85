// read_earlier_patch.cpp: a patch of made files, and files that do not fit together.
#include "prepare/read_earlier_patch.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "base/molecule/earlier_patch.h"
#include "io/vtk/write_vtp.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

/// OUT.json and OUT.vtp of a square of 4 A2, two triangles: patch 1 has three of the four corners, 2 + 4/3 A2.
struct MadeResult {
  ScratchFolder folder;
  std::string area = "3.3333333333333335";
  std::string second_residue = "GLY 2B of chain A";
  std::vector<std::int32_t> patch{1, 1, 1, 0};
  std::vector<double> residue{0, 0, 1, -1};

  EarlierPatch read(const std::string& number = "1") const {
    folder.write("out.json", R"({"plan": {"residues": ["ALA 1 of chain A", ")" + second_residue +
                                 R"("], "replicates":)"
                                 R"( [{"sha256": ["ab", "cd"]}]}, "patches": [{"area_A2": )" +
                                 area + "}]}");
    const std::vector<Vec3d> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {1, 3, 2}};
    VtpSurface surface;
    surface.points = {"", positions};
    surface.triangles = &triangles;
    surface.point_arrays = {{"patch", patch}, {"residue_index", residue}};
    std::ostringstream text;
    write_vtp(text, surface);
    folder.write("out.vtp", text.str());
    return *read_earlier_patch({folder.file("out.json"), number});
  }
  std::string refusal(const std::string& number = "1") const {
    const std::string message = message_of([&] { read(number); });
    const std::string in = folder.file("");
    return message.rfind(in, 0) == 0 ? message.substr(in.size()) : message;
  }
};

}  // namespace

TEST_CASE("read_earlier_patch: vertices, residues and runs of a patch") {
  const EarlierPatch patch = MadeResult().read();
  CHECK(patch.number == 1);
  CHECK(patch.area_A2 == doctest::Approx(10.0 / 3));
  CHECK(patch.inside == std::vector<std::uint8_t>{1, 1, 1, 0});
  CHECK(patch.residue == std::vector<std::int32_t>{0, 0, 1, -1});
  REQUIRE(patch.residues.size() == 2);
  CHECK(patch.residues[1].name == "GLY");
  CHECK(patch.residues[1].number == 2);
  CHECK(patch.residues[1].insertion_code == 'B');
  CHECK(patch.residues[1].chain == "A");
  CHECK(patch.runs_sha256 == std::vector<std::string>{"ab", "cd"});
}

TEST_CASE("read_earlier_patch: numbers without a patch, and files of two runs") {
  MadeResult made;
  for (const char* const number : {"0", "2", "99999999999999999999"})
    CHECK(made.refusal(number) ==
          "out.json: there is no patch " + std::string(number) + "; it has 1 patch, numbered from 1");
  for (const char* const area : {"3.2", "-1", "0", "1e300"}) {
    made.area = area;
    CHECK(made.refusal().find("out.vtp: its patch 1 has another area than in") == 0);
  }
  // No vertex, and no area: nothing that could be placed.
  made.area = "0";
  made.patch.assign(4, 0);
  CHECK(made.refusal().find("out.vtp: its patch 1 has another area than in") == 0);
}

TEST_CASE("read_earlier_patch: residues that the record lacks") {
  MadeResult made;
  for (const double residue : {2.0, 0.5, -2.0, 1e300}) {
    made.residue.back() = residue;
    CHECK(made.refusal().find("out.vtp: a vertex belongs to no residue of") == 0);
  }
}

TEST_CASE("read_earlier_patch: residues whose numbers would be others are refused") {
  MadeResult made;
  for (const char* const label : {"GLY 4294967297 of chain A", "GLY", "GLY 2BC", "GLY  2"}) {
    made.second_residue = label;
    CHECK(made.refusal() ==
          "out.json: a residue is '" + std::string(label) + "', which an ensemble does not write; run it again");
  }
}
