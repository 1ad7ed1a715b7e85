// residue_csv.cpp: the residues of a trajectory: rows, resuming wherever a run broke off, and what is refused.
#include "trajectory/residue_csv.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "certificate/result.h"
#include "io/files/read_csv.h"
#include "support/test_data.h"
#include "trajectory/residue_plot.h"

using namespace espdiff_test;
using espdiff::CompareResult;
using espdiff::ExistingFile;
using espdiff::FrameMap;
using espdiff::Molecule;
using espdiff::ResidueCsv;
using espdiff::ResidueRow;

namespace {

Molecule molecule() {
  Molecule m;
  m.residues = {{"LYS", "A", 12, ' '}, {"GLY", "A", 12, 'B'}, {"HEM", "", 1, ' '}};
  return m;
}

CompareResult result(double first) {
  CompareResult made;
  made.potential.compared = true;
  made.potential.unit = espdiff::PotentialUnit::kKtPerE;
  for (std::size_t r = 0; r < 3; ++r) {
    ResidueRow row;
    row.residue = r;
    row.mean_abs_difference = r == 1 ? std::nan("") : first + static_cast<double>(r);
    row.mean_displacement_A = 0.25;
    made.residues.push_back(row);
  }
  return made;
}

void add(ResidueCsv& file, int frame, double value) {
  file.add(file.row(frame, molecule(), molecule(), result(value)), "abc");
}

constexpr const char* kResidueHead =
    "# residues: mean_abs_difference [kT/e]\n# trajectory: abc\nframe,A:LYS 12,A:GLY 12B,HEM 1\n";

}  // namespace

TEST_SUITE_BEGIN("trajectory");

TEST_CASE("residues of a trajectory: a row a frame, empty where a residue has no surface") {
  const ScratchFolder folder;
  const std::string path = folder.file("r.csv");
  {
    ResidueCsv file(path, "", ExistingFile::kRefuse);
    add(file, 3, 0.5);
    add(file, 5, 1.5);
  }
  CHECK(read_file(path) == std::string(kResidueHead) + "3,0.5,,2.5\n5,1.5,,3.5\n");
  CHECK(message_of([&] { ResidueCsv(path, "", ExistingFile::kRefuse); }) ==
        path + ": the file exists; resume continues it, overwrite replaces it");
  ResidueCsv other(folder.file("s.csv"), "mean_displacement_A", ExistingFile::kRefuse);
  add(other, 0, 0.5);
  CHECK(read_file(folder.file("s.csv")).find("\n0,0.25,0.25,0.25\n") != std::string::npos);
  CHECK(message_of([&] {
          ResidueCsv(folder.file("t.csv"), "rmsd", ExistingFile::kRefuse);
        }).rfind("residues have no quantity 'rmsd'; there are: share, contribution, area_A2, ", 0) == 0);
  CHECK(folder.n_files() == 2);
}

TEST_CASE("residues of a trajectory are resumed at every byte to the same bytes") {
  const ScratchFolder folder;
  const std::string path = folder.file("r.csv"), head = kResidueHead, whole = head + "3,0.5,,2.5\n5,1.5,,3.5\n";
  // Frame 3 is done, since the trajectory's file has its row; the row of frame 5 is computed again.
  for (std::size_t n = head.size() + 11; n <= whole.size(); ++n) {
    CAPTURE(n);
    std::ofstream(path) << whole.substr(0, n);
    ResidueCsv file(path, "", ExistingFile::kResume);
    file.resume({"3"}, "abc");
    add(file, 5, 1.5);
    CHECK(read_file(path) == whole);
  }
  // What is to be replaced stays until the first row.
  {
    ResidueCsv file(path, "mean_displacement_A", ExistingFile::kReplace);
    file.resume({}, "abc");
    CHECK(read_file(path) == whole);
    add(file, 0, 0.5);
    CHECK(contains(read_file(path), "\n0,0.25,0.25,0.25\n"));
    CHECK_FALSE(contains(read_file(path), "\n3,"));
  }
  // Nothing is done: the file begins anew over the head, or the one row, of a killed run.
  for (const std::size_t n : {std::size_t{0}, std::size_t{5}, head.size(), head.size() + 11}) {
    std::ofstream(path) << whole.substr(0, n);
    ResidueCsv file(path, "", ExistingFile::kResume);
    file.resume({}, "abc");
    add(file, 3, 0.5);
    add(file, 5, 1.5);
    CHECK(read_file(path) == whole);
  }
}

TEST_CASE("residues of another run are refused, and the file is left as it is") {
  const ScratchFolder folder;
  const std::string path = folder.file("r.csv"), whole = std::string(kResidueHead) + "3,0.5,,2.5\n5,1.5,,3.5\n";
  const auto refused = [&](const std::string& text, const std::vector<std::string>& frames, const char* quantity = "",
                           const char* fingerprint = "abc") {
    std::ofstream(path) << text;
    const std::string message = message_of([&] {
      ResidueCsv file(path, quantity, ExistingFile::kResume);
      file.resume(frames, fingerprint);
    });
    CHECK(read_file(path) == text);
    CHECK(message.rfind(path + ":", 0) == 0);
    return message.substr(path.size());
  };
  CHECK(refused("", {"3"}) ==
        ": has no rows, while the run has 1; the residues of a run are written from its first frame on; overwrite "
        "begins anew");
  // Also where the run has no rows yet: nobody's file is replaced.
  CHECK(refused("a,b\n1,2\n", {}) == ":1: this is not a trajectory's table of residues; give another file");
  CHECK(refused("no line end", {}).find("there is no row of column names") != std::string::npos);
  CHECK(refused(whole, {}) == ": has 2 rows, and the run 0; overwrite begins anew");
  CHECK(refused("a,b\n1,2\n", {"3"}) == ":1: this is not a trajectory's table of residues; give another file");
  CHECK(refused(whole, {"3", "6"}) == ": row 2 is frame 5, not frame 6; overwrite begins anew");
  CHECK(refused(whole, {"3", "5", "6"}) == ": row 3 is missing, not frame 6; overwrite begins anew");
  CHECK(refused(whole + "6,1,,1\n", {"3"}) == ": has 3 rows, and the run 1; overwrite begins anew");
  CHECK(refused(whole, {"3"}, "", "xyz").find(": has mean_abs_difference of another run") == 0);
  CHECK(refused(whole, {"3"}, "mean_slip_A") ==
        ": has mean_abs_difference of another run, or mean_slip_A was asked for; overwrite begins anew");
}

TEST_CASE(
    "residues of a target with other numbers and chains: their partners stand in the head, and stay when resumed") {
  const ScratchFolder folder;
  const std::string path = folder.file("r.csv");
  Molecule source = molecule(), target = molecule();
  target.residues = {{"GLY", "B", 13, 'B'}, {"LYS", "B", 13, ' '}, {"HEM", "", 1, ' '}};
  CompareResult paired = result(0.5);
  const std::vector<std::int32_t> of_atoms = {0, 1, 2};
  for (Molecule* m : {&source, &target}) {
    for (const std::int32_t residue : of_atoms) {
      m->atoms.push_back({"CA", "C", residue, false});
      m->positions.push_back({});
    }
  }
  paired.alignment.pairing.pairs = {{0, 1}, {2, 2}};  // LYS and HEM; GLY has none
  const auto add_frame = [&](ResidueCsv& file, int frame) { file.add(file.row(frame, source, target, paired), "abc"); };
  const std::string head =
      "# residues: mean_abs_difference [kT/e]\n# trajectory: abc\n# partners: ,B:LYS 13,,HEM 1\n"
      "frame,A:LYS 12,A:GLY 12B,HEM 1\n";
  const std::string whole = head + "3,0.5,,2.5\n5,0.5,,2.5\n";
  {
    ResidueCsv file(path, "", ExistingFile::kRefuse);
    add_frame(file, 3);
    add_frame(file, 5);
  }
  CHECK(read_file(path) == whole);
  const FrameMap map = espdiff::residue_map(espdiff::read_csv(path));
  CHECK(map.labels == std::vector<std::string>{"A:LYS 12", "HEM 1"});
  CHECK(map.partners == std::vector<std::string>{"B:LYS 13", "HEM 1"});
  for (std::size_t n = 0; n <= whole.size(); ++n) {
    CAPTURE(n);
    const bool first_is_there = n >= head.size() + 11;
    std::ofstream(path) << whole.substr(0, n);
    ResidueCsv file(path, "", ExistingFile::kResume);
    file.resume(first_is_there ? std::vector<std::string>{"3"} : std::vector<std::string>{}, "abc");
    if (!first_is_there) add_frame(file, 3);
    add_frame(file, 5);
    CHECK(read_file(path) == whole);
  }
}

TEST_CASE("a frame with other residues is refused") {
  const ScratchFolder folder;
  ResidueCsv file(folder.file("r.csv"), "", ExistingFile::kRefuse);
  add(file, 0, 1);
  Molecule other = molecule();
  other.residues[0].number = 13;
  CHECK(message_of([&] { file.row(1, other, other, result(1)); }) ==
        folder.file("r.csv") + ": this frame has other residues than the first: 3 instead of 3, or other names");
}

TEST_SUITE_END();
