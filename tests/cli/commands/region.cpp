// region.cpp: --region, --region-within and --of in `espdiff trajectory` and `espdiff matrix`: what compare says of
// them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/bent_row.h"
#include "cli/run_espdiff.h"
#include "io/files/read_csv.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

/// Three states; the second has a ligand beside it.
struct RegionFiles {
  ScratchFolder folder;
  std::string a, b, c, frames;
  RegionFiles() {
    a = folder.write("a.pqr", bent_row(0));
    b = folder.write("b.pqr",
                     bent_row(0.3) + "HETATM   10  C1  LIG B   1       3.000   4.500   0.000  0.0000 1.7000\n");
    c = folder.write("c.pqr", bent_row(0.6));
    frames = folder.write("frames.pqr", "MODEL 1\n" + bent_row(0.3) + "ENDMDL\nMODEL 2\n" + bent_row(0.6) +
                                            "ENDMDL\nMODEL 3\n" + bent_row(0.9) + "ENDMDL\n");
  }
  std::string out(const std::string& name) const { return folder.file(name); }
};

void check_run(const std::string& arguments) {
  const Outcome outcome = run_espdiff(arguments + kUsual);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
}

std::string refused_region(const std::string& arguments) {
  const Outcome outcome = run_espdiff(arguments + kUsual);
  CHECK(outcome.status == 2);
  CHECK(n_lines(outcome.err) == 1);
  return outcome.err;
}

/// Each value under `region` of a comparison must stand under its column.
/// @param digits a relative difference, where the file has fewer digits
void check_region(const Json& whole, const espdiff::CsvTable& table, std::size_t row, double digits = 0) {
  const Json& region = whole["region"];
  const auto same = [&](const std::string& column, const Json& value) {
    const double there = std::stod(cell(table, row, column)), here = value.get<double>();
    CHECK_MESSAGE(std::fabs(there - here) <= digits * std::fabs(here), column << ": " << there << ", " << here);
  };
  for (const char* metric : {"rmsd_A", "mean_abs_difference", "mean_signed_difference", "hodgkin_index",
                             "mean_displacement_A", "sign_change_area_fraction"}) {
    same(std::string("region_") + metric, region[metric]);
  }
  same("region_area_mapped_A2", region["area_A2"]["mapped"]);
  same("region_no_counterpart_source", region["certificate"]["no_counterpart_area_fraction"]["source"]);
  CHECK(region["mean_abs_difference"].get<double>() > 0.001);
  CHECK(cell(table, row, "region_trustworthy") == (region["certificate"]["trustworthy"].get<bool>() ? "1" : "0"));
  CHECK(region["mean_abs_difference"] != whole["mean_abs_difference"]);
}

}  // namespace

TEST_CASE("trajectory: the region's columns are compare's region, frame by frame, and resume to the same bytes") {
  const RegionFiles files;
  const std::string region = " --region '//*/1-4' ";
  const std::string run = "trajectory " + files.a + " " + files.frames + region;
  check_run(run + "-o " + files.out("t.csv"));
  const espdiff::CsvTable table = espdiff::read_csv(files.out("t.csv"));
  for (int model = 1; model <= 3; ++model) {
    check_run("compare --exit-zero --overwrite --no-trials " + files.a + " " + files.frames + region +
              "--target-model " + std::to_string(model) + " -o " + files.out("one"));
    check_region(Json::parse(read_file(files.out("one.json"))), table, static_cast<std::size_t>(model - 1));
  }
  CHECK(cell(table, 0, "region_reasons").size() < 500);
  CHECK(std::find(table.columns.begin(), table.columns.end(), "region_slip_mean_A") == table.columns.end());
  // Cut within the last row.
  const std::string whole = read_file(files.out("t.csv"));
  files.folder.write("t.csv", whole.substr(0, whole.size() - 20));
  check_run(run + "--resume -o " + files.out("t.csv"));
  CHECK(read_file(files.out("t.csv")) == whole);
  CHECK(contains(refused_region("trajectory " + files.a + " " + files.frames + " --resume -o " + files.out("t.csv")),
                 "was made with settings"));
}

TEST_CASE("trajectory: without a region there are no such columns; a frame with an error has all columns") {
  const RegionFiles files;
  check_run("trajectory " + files.a + " " + files.frames + " -o " + files.out("t.csv"));
  CHECK_FALSE(contains(read_file(files.out("t.csv")), "region"));
  const std::string frames =
      files.folder.write("odd.pqr", "MODEL 1\n" + bent_row(0.3) + "ENDMDL\nMODEL 2\n" + row_of_atoms(1, 0.6, "GLY") +
                                        "ENDMDL\nMODEL 3\n" + bent_row(0.9) + "ENDMDL\n");
  check_run("trajectory " + files.a + " " + frames + " --region '//*/1-4' --on-error skip -o " + files.out("odd.csv"));
  const espdiff::CsvTable table = espdiff::read_csv(files.out("odd.csv"));
  REQUIRE(table.rows.size() == 3);
  CHECK_FALSE(cell(table, 1, "error").empty());
  CHECK(cell(table, 1, "region_rmsd_A").empty());
  CHECK_FALSE(cell(table, 2, "region_rmsd_A").empty());
}

TEST_CASE("trajectory: a region near atoms of the source's file that are not compared; one that is empty") {
  const RegionFiles files;
  const std::string near_to = " --select '(ALA)' --region-within 4 --of '(LIG)' -o ";
  check_run("trajectory " + files.b + " " + files.frames + near_to + files.out("t.csv"));
  CHECK_FALSE(cell(espdiff::read_csv(files.out("t.csv")), 0, "region_mean_abs_difference").empty());
  CHECK(contains(refused_region("trajectory " + files.a + " " + files.frames + near_to + files.out("u.csv")),
                 "--of '(LIG)' selects no atom; " + files.a + " has "));
  CHECK(contains(
      refused_region("trajectory " + files.a + " " + files.frames + " --region '//Q' -o " + files.out("u.csv")),
      "--region '//Q' selects no atom"));
  CHECK_FALSE(std::filesystem::exists(files.out("u.csv")));
}

TEST_CASE("matrix: the region's values are compare's region, in files, states and parts") {
  const RegionFiles files;
  const std::string region = " --region '//*/1-4' ", run = "matrix " + files.a + " " + files.b + " " + files.c + region;
  check_run(run + "--cluster-by region_mean_abs_difference -o " + files.out("m"));
  const espdiff::CsvTable table = espdiff::read_csv(files.out("m.csv"));
  check_run("compare --exit-zero --overwrite --no-trials " + files.a + " " + files.c + region + "-o " +
            files.out("one"));
  const Json one = Json::parse(read_file(files.out("one.json")));
  check_region(one, table, 1, 1e-5);
  const Json matrix = Json::parse(read_file(files.out("m.json")));
  const Json& metric = matrix["metrics"]["region_mean_abs_difference"];
  CHECK(metric["values"][0][2] == one["region"]["mean_abs_difference"]);
  CHECK(metric["title"] == "Mean absolute difference, region");
  CHECK(metric["unit"] == "kT/e");
  CHECK(matrix["clustering"]["metric"] == "region_mean_abs_difference");
  CHECK(matrix["region_trustworthy"][0][2] == one["region"]["certificate"]["trustworthy"]);
  for (const char* part : {"1/2", "2/2"}) check_run(run + "--shard " + part + " -o " + files.out("p"));
  const Outcome merged =
      run_espdiff("merge " + files.out("p.shard-1-of-2.state") + " " + files.out("p.shard-2-of-2.state") +
                  " --cluster-by region_mean_abs_difference -q -o " + files.out("p"));
  CHECK_MESSAGE(merged.status == 0, merged.err);
  CHECK(read_file(files.out("p.csv")) == read_file(files.out("m.csv")));
  CHECK(read_file(files.out("p.json")) == read_file(files.out("m.json")));
  const Outcome printed = run_espdiff(run + "--overwrite --device cpu --pb-spacing 1 -o " + files.out("m"));
  CHECK(contains(printed.out, "Mean absolute difference, region"));
}

TEST_CASE("matrix: a variant without the atoms takes the region of the first one that has them") {
  const RegionFiles files;
  const std::string near_to = " --select '(ALA)' --region-within 4 --of '(LIG)' -o ";
  check_run("matrix " + files.a + " " + files.b + " " + files.c + near_to + files.out("m"));
  check_run("compare --exit-zero --overwrite --no-trials " + files.a + " " + files.b + near_to + files.out("one"));
  const espdiff::CsvTable table = espdiff::read_csv(files.out("m.csv"));
  check_region(Json::parse(read_file(files.out("one.json"))), table, 0, 1e-5);
  CHECK_FALSE(cell(table, 1, "region_rmsd_A").empty());  // neither of the two has the ligand
  CHECK(contains(refused_region("matrix " + files.a + " " + files.c + near_to + files.out("u")),
                 "--of '(LIG)' selects no atom; " + files.a));
  const std::string nothing =
      refused_region("matrix " + files.a + " " + files.c + " --region '//Q' -o " + files.out("u"));
  CHECK_MESSAGE(contains(nothing, files.a + ": --region '//Q' selects no atom"), nothing);
  CHECK_FALSE(std::filesystem::exists(files.out("u.csv")));
}
