// plot.cpp: `espdiff plot` of a matrix and of a table, and wrong usage.
#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

bool has_gnuplot() {
  const bool found = std::system("gnuplot --version >/dev/null 2>&1") == 0;
  if (!found) MESSAGE("SKIPPED: gnuplot is not installed (Debian: gnuplot-nox)");
  return found;
}

/// A matrix of three molecules, shapes alone.
std::string made_matrix(const ScratchFolder& folder) {
  std::string molecules;
  for (int i = 0; i < 3; ++i) molecules += " " + folder.write("m" + std::to_string(i) + ".pqr", row_of_atoms(9 + i));
  const std::string groups = folder.write("g.csv", "label,group\nm0,first\nm1,first\nm2,second\n");
  REQUIRE(run_espdiff("matrix" + molecules + " --groups " + groups + " --potential none -q -o " + folder.file("m"))
              .status == 0);
  return folder.file("m.json");
}

}  // namespace

TEST_CASE("a matrix as heat map, and one of its variants against all") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string matrix = made_matrix(folder), svg = folder.file("x.svg");
  const Outcome map = run_espdiff("plot " + matrix + " --order dendrogram -o " + svg);
  REQUIRE_MESSAGE(map.status == 0, map.err);
  std::string text = read_file(svg);
  for (const char* word : {"m0", "m1", "m2", "first", "second", "Mean displacement (\u00C5)", "clustered by"})
    CHECK_MESSAGE(contains(text, word), std::string(word), text);
  // The table stands for the JSON beside it.
  const std::string table = folder.file("m.csv"), of_table = folder.file("csv.svg");
  const Outcome by_table = run_espdiff("plot " + table + " --order dendrogram -o " + of_table);
  REQUIRE_MESSAGE(by_table.status == 0, by_table.err);
  CHECK(read_file(of_table) == text);
  CHECK(run_espdiff("plot " + table + " --source m1 --overwrite -o " + of_table).status == 0);
  const Outcome lines = run_espdiff("plot " + matrix + " --source m1 --metric rmsd_A --metric no_counterpart_source " +
                                    "--both-ways --overwrite -o " + svg);
  REQUIRE_MESSAGE(lines.status == 0, lines.err);
  text = read_file(svg);
  for (const char* word : {"m1 against all others", "RMSD (\u00C5)", "Unmatched area, source (%)", "Variant"})
    CHECK_MESSAGE(contains(text, word), std::string(word), text);
}

TEST_CASE("a plot needs no folder for temporary files") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string table = folder.write("t.csv", "frame,a\n0,1\n10,2\n");
  // As VMD sets it on Debian: to a folder that does not exist.
  const Outcome outcome = run_espdiff("plot " + table + " --metric a -o " + folder.file("t.svg"), "TMPDIR=/usr/tmp/no");
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(read_file(folder.file("t.svg")), "Frame"));
}

TEST_CASE("columns of a table along its frames, with error bars where a column has them") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string table =
      folder.write("t.csv",
                   "# espdiff: 1\nframe,potential_unit,mean_abs_difference,rmsd_A,heat,heat_error,"
                   "trustworthy\n0,kT/e,1,0.5,3,0.1,1\n10,kT/e,,0.6,4,,0\n20,kT/e,3,0.7,5,0.3,1\n");
  const std::string svg = folder.file("t.svg");
  const Outcome outcome =
      run_espdiff("plot " + table + " --metric mean_abs_difference --metric rmsd_A --metric heat -o " + svg);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const std::string text = read_file(svg);
  for (const char* word : {"Mean absolute difference (kT/e)", "RMSD (\u00C5)", ">heat<", "Frame", "not trustworthy"})
    CHECK_MESSAGE(contains(text, word), std::string(word), text);
  CHECK(run_espdiff("plot " + table + " -o " + folder.file("t.png")).status == 0);
}

TEST_CASE("columns of a patch have its metrics' titles and units") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string table = folder.write(
                        "t.csv",
                        "frame,lid_rmsd_A,lid_no_counterpart_source,lid_trustworthy\n0,1.5,0.25,1\n1,2,0.5,1\n"),
                    svg = folder.file("x.svg");
  const Outcome lines =
      run_espdiff("plot " + table + " --metric lid_rmsd_A lid_no_counterpart_source lid_trustworthy -o " + svg);
  REQUIRE_MESSAGE(lines.status == 0, lines.err);
  const std::string text = read_file(svg);
  for (const char* word : {"RMSD, lid (\u00C5)", "(%)", "lid_trustworthy"}) CHECK_MESSAGE(contains(text, word), word);
}

TEST_CASE("a comparison is drawn from any of its files, with both states") {
  const ScratchFolder folder;
  const std::string head =
      "chain,residue_number,insertion_code,residue_name,area [A^2],mean_signed_difference [kT/e],mean_source [kT/e],"
      "mean_target [kT/e]\n";
  const std::string table =
      folder.write("r.residues.csv", head + "A,8,,LYS,100,-1.5,2.5,1\nA,9,,ASP,90,0.5,-1,-0.5\nA,10,,GLY,0,,,\n");
  folder.write("r.json", "{}");
  folder.write("r.vtp", "");
  for (const std::string given : {"r", "r.json", "r.vtp", "r.residues.csv"}) {
    const std::string svg = folder.file(given + ".svg");
    const Outcome bars = run_espdiff("plot " + folder.file(given) + " -o " + svg);
    REQUIRE_MESSAGE(bars.status == 0, bars.err);
    const std::string text = read_file(svg);
    for (const char* word : {"LYS A8", "ASP A9", "kT/e", "source", "target"}) CHECK_MESSAGE(contains(text, word), word);
    CHECK_FALSE(contains(text, "GLY"));
  }
  const std::string svg = folder.file("top.svg");
  REQUIRE(run_espdiff("plot " + table + " --top 1 -o " + svg).status == 0);
  CHECK_FALSE(contains(read_file(svg), "ASP"));
  REQUIRE(run_espdiff("plot " + table + " --kind scatter --title both --overwrite -o " + svg).status == 0);
  for (const char* word : {"source (kT/e)", "target (kT/e)", "both", "LYS A8"})
    CHECK_MESSAGE(contains(read_file(svg), word), word);
  const Outcome shapes = run_espdiff(
      "plot " +
      folder.write("s.residues.csv", "chain,residue_number,insertion_code,residue_name,area [A^2]\nA,1,,ALA,3\n") +
      " --overwrite -o " + svg);
  CHECK(shapes.status == 2);
  CHECK(contains(shapes.err, "has no potentials of both states; compare with charges or maps"));
  CHECK(contains(run_espdiff("plot " + table + " --metric rmsd_A --overwrite -o " + svg).err,
                 "is one of a comparison's residues"));
}

TEST_CASE("plots of a study have the widest range of all its results") {
  if (!has_gnuplot()) return;
  const ScratchFolder folder;
  const std::string head =
      "chain,residue_number,insertion_code,residue_name,area [A^2],mean_signed_difference [kT/e],mean_source [kT/e],"
      "mean_target [kT/e]\n";
  const auto result = [&](const std::string& name, const std::string& row, const std::string& columns) {
    folder.write(name + ".residues.csv", columns + row);
    folder.write(name + ".json", "{}");
    folder.write(name + ".vtp", "");
    return folder.file(name);
  };
  const std::string narrow = result("narrow", "A,8,,LYS,100,-0.5,1,0.5\n", head),
                    wide = result("wide", "A,8,,LYS,100,-30,10,-20\n", head),
                    volts = result("volts", "A,8,,LYS,100,-30,10,-20\n",
                                   std::regex_replace(head, std::regex("kT/e"), "mV"));
  const auto drawn = [&](const std::string& arguments) {
    const Outcome out = run_espdiff("plot " + arguments + " --overwrite -o " + folder.file("x.svg"));
    REQUIRE_MESSAGE(out.status == 0, out.err);
    return read_file(folder.file("x.svg"));
  };
  for (const std::string kind : {" --kind bars", " --kind scatter"}) {
    CHECK_FALSE(contains(drawn(narrow + kind), ">-20<"));
    CHECK(contains(drawn(narrow + kind + " --range-of " + wide + ".json"), ">-20<"));
    CHECK(contains(drawn(wide + kind + " --range-of " + narrow), ">-20<"));
  }
  const std::string one = made_matrix(folder);
  auto json = nlohmann::json::parse(read_file(one));
  json["metrics"]["rmsd_A"]["values"][0][1] = 777;
  const std::string two = folder.write("two.json", json.dump());
  CHECK_FALSE(contains(drawn(one + " --metric rmsd_A"), "> 700<"));
  CHECK(contains(drawn(one + " --metric rmsd_A --range-of " + two), "> 700<"));
  for (const auto& refused : std::vector<std::pair<std::string, std::string>>{
           {narrow + " --range-of " + volts, "results that share a scale have one unit"},
           {narrow + " --range-of " + one, "is no comparison's; --range-of takes results of one kind"},
           {one + " --range-of " + narrow, "is no matrix; --range-of takes results of one kind"},
           {one + " --range 0 1 --range-of " + two, "--range-of and --range exclude each other"},
           {one + " --source m0 --range-of " + two, "--range, --range-of and --order are for heat maps"},
           {narrow + " --range-of " + folder.file("none"), "none: "}}) {
    const Outcome wrong = run_espdiff("plot " + refused.first + " -o " + folder.file("y.svg"));
    CHECK_MESSAGE(wrong.status == 2, refused.first);
    CHECK_MESSAGE(contains(wrong.err, refused.second), wrong.err);
  }
}

TEST_CASE("wrong usage of plot exits 2 and writes nothing") {
  const ScratchFolder folder;
  const std::string matrix = made_matrix(folder), table = folder.write("t.csv", "frame,a\n0,1\n");
  const std::size_t n_files = folder.n_files();
  const std::string svg = " -o " + folder.file("x.svg");
  for (const auto& wrong : std::vector<std::pair<std::string, std::string>>{
           {matrix + " -o x.pdf", "ends in .png or .svg"},
           {matrix + " --metric size" + svg, "there is no metric 'size'"},
           {matrix + " --source m9" + svg, "there is no variant 'm9'; there are: m0, m1, m2"},
           {matrix + " --metric rmsd_A --metric iterations" + svg, "one metric"},
           {matrix + " --range 3 1" + svg, "--range"},
           {matrix + " --normalize" + svg, "name one --source"},
           {table + " --metric b" + svg, "there is no column 'b'"},
           {table + " --source m0" + svg, "give its OUT.json"},
           {folder.write("alone.csv", "source,target,rmsd_A\na,b,1\n") + svg,
            "a matrix is drawn from its JSON file, and there is no " + folder.file("alone.json")},
           {folder.write("x.json", "{}") + svg, "not the JSON that `espdiff matrix` writes"}}) {
    const Outcome outcome = run_espdiff("plot " + wrong.first);
    CHECK_MESSAGE(outcome.status == 2, wrong.first);
    CHECK_MESSAGE(contains(outcome.err, wrong.second), outcome.err);
  }
  CHECK(folder.n_files() == n_files + 2);
}
