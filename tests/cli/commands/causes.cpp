// causes.cpp: --causes of `espdiff compare`: files, sums, what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_espdiff.h"
#include "io/files/read_csv.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

/// Two rows of charged residues; in the second the last residue's side chain is elsewhere and residue 3 is another one.
struct CausesFiles {
  ScratchFolder folder;
  std::string source, target;

  static std::string row(bool changed) {
    std::string text;
    int serial = 0;
    for (int r = 1; r <= 6; ++r) {
      const char* const name = r == 3 && changed ? "GLU" : r == 6 ? "LYS" : "SER";
      const char* const atoms[] = {"N", "CA", "C", "O", "CB"};
      for (int i = 0; i < 5; ++i) {
        char line[128];
        const double out = i == 4 && r == 6 && changed ? 3.5 : 0;
        const double charge = i == 4 ? (r == 6 ? 1.0 : r == 3 && changed ? -1.0 : 0.1) : 0.2 * (i % 2) - 0.1;
        std::snprintf(line, sizeof line, "ATOM  %5d  %-3s %3s A%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", ++serial,
                      atoms[i], name, r, 3.6 * r + 0.8 * i, 1.3 * (i % 3) + 0.1 * r, 0.9 * (i % 2) + out, charge, 1.7);
        text += line;
      }
    }
    return text;
  }
  /// The first row with a whole lysine at its end, whose second angle is as in the file or half a turn from it.
  static std::string with_lysine(int half_turns) {
    std::string text = row(false);
    const struct {
      const char* name;
      double x, y, z, charge;
    } more[] = {
        {"CG", 0.7, 1.2, 1.6, 0}, {"CD", 0.1, 1.1, 3.0, 0}, {"CE", 0.8, 2.3, 3.8, 0.3}, {"NZ", 0.2, 2.2, 5.2, 0.7}};
    int serial = 30;
    for (const auto& atom : more) {
      char line[128];
      const double side = half_turns > 0 && serial > 30 ? -1 : 1;  // mirrored beyond the second bond: another angle
      std::snprintf(line, sizeof line, "ATOM  %5d  %-3s LYS A   6    %8.3f%8.3f%8.3f %7.4f %6.4f\n", ++serial,
                    atom.name, 24.8 + side * atom.x + (side < 0 ? 1.4 : 0), 1.9 + atom.y, atom.z, atom.charge, 1.7);
      text += line;
    }
    return text;
  }
  CausesFiles() : source(folder.write("a.pqr", row(false))), target(folder.write("b.pqr", row(true))) {}

  Outcome run(const std::string& options, const std::string& other = "") const {
    return run_espdiff("compare " + source + " " + (other.empty() ? target : other) + " -o " + folder.file("out") +
                       " --domains none --exit-zero --overwrite " + options);
  }
  Json json() const { return Json::parse(read_file(folder.file("out.json"))); }
};

}  // namespace

TEST_CASE("causes: contributions add up to the metric, in JSON, CSV and the table") {
  const CausesFiles files;
  for (const std::string potential : {"--potential pb --pb-spacing 0.8", "--potential coulomb"}) {
    const Outcome outcome = files.run(potential +
                                      " --region '//A/1-3' --patch end=//A/6 --causes region --causes 'patch end' "
                                      "--causes 'residue A:2' --causes whole --offset 0.5");
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    CHECK(contains(outcome.out, "Causes of the difference, patch end"));
    CHECK(contains(outcome.out, "no file says how well places are known"));
    const Json json = files.json();
    REQUIRE(json["causes"].size() == 4);
    const espdiff::CsvTable table = espdiff::read_csv(files.folder.file("out.causes.csv"));
    CHECK(table.rows.size() == 4 * 6);
    const std::size_t difference_column =
        table.require("difference [" + json["causes"][0]["unit"].get<std::string>() + "]");
    const double wanted[] = {json["region"]["mean_signed_difference"],
                             json["fixed_patches"]["end"]["mean_signed_difference"], 0, json["mean_abs_difference"]};
    for (std::size_t r = 0; r < 4; ++r) {
      const Json& reading = json["causes"][r];
      CAPTURE(reading["reading"]);
      const double difference = reading["difference"], largest = reading["largest"][0]["difference"];
      if (r != 2) CHECK(difference == doctest::Approx(wanted[r]).epsilon(1e-5));
      for (const char* side : {"source", "target"})
        CHECK(std::fabs(reading["sum_of_contributions"][side].get<double>() - reading[side].get<double>()) <
              1e-5 * std::max(std::fabs(largest), std::fabs(reading[side].get<double>())));
      double sum = 0;
      for (std::size_t i = 0; i < 6; ++i) sum += table.number(6 * r + i, difference_column);
      CHECK(sum == doctest::Approx(difference).epsilon(1e-3));
    }
    CHECK(json["causes"][0]["largest"][0]["residue"] == "SER 3");
    CHECK(json["causes"][0]["largest"][0]["kind"] == "substituted");
    CHECK(json["causes"][0]["largest"][0]["detail"] == "SER to GLU");
  }
}

TEST_CASE("causes: bars are drawn of any file of the result; one without causes says how to get them") {
  const CausesFiles files;
  REQUIRE(files.run("--potential coulomb --region '//A/1-3' --causes region --causes whole").status == 0);
  const std::string svg = files.folder.file("bars.svg");
  for (const char* name : {"out", "out.json", "out.vtp", "out.causes.csv"}) {
    const Outcome outcome = run_espdiff("plot " + files.folder.file(name) + " --causes --overwrite -o " + svg);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const std::string text = read_file(svg);
    for (const char* word : {"region: ", "whole: ", "SER 3 A, substituted", "kT/e"})
      CHECK_MESSAGE(contains(text, word), word);
  }
  const std::string inserted = files.folder.write(
      "i.causes.csv",
      "reading,chain,residue_number,insertion_code,residue_name,kind,difference [kT/e],poorly_known\n"
      "whole,A,105,B,LYS,moved,0.5,0\nwhole,A,105,,GLY,moved,0.25,0\n");
  REQUIRE(run_espdiff("plot " + inserted + " --overwrite -o " + svg).status == 0);
  for (const char* word : {"LYS 105B A, moved", "GLY 105 A, moved"})
    CHECK_MESSAGE(contains(read_file(svg), word), word);
  const Outcome without = run_espdiff("plot " + files.source + " --causes -o " + svg);
  CHECK(without.status == 2);
  CHECK(contains(without.err, "a.pqr.causes.csv: no such file; compare with --causes first, such as --causes whole"));
}

TEST_CASE("causes: a scan says what residues' charges do to the reading, and writes a table") {
  const CausesFiles files;
  const std::string options = "--potential pb --pb-spacing 0.8 --region '//A/1-3' --causes region --causes whole";
  const Outcome outcome = files.run(options + " --scan");
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "scan, kT/e in the source, shape and protonation kept: without its charges"));
  const Json reading = files.json()["causes"][0], scan = reading["scan"];
  CHECK(scan["kept"] == "shape and protonation");
  const espdiff::CsvTable table = espdiff::read_csv(files.folder.file("out.scan.csv"));
  CHECK(table.rows.size() == 2 * 6);
  for (const Json& one : scan["largest"]) {
    for (const Json& cause : reading["largest"]) {
      if (cause["residue"] != one["residue"]) continue;
      CHECK(one["removed"]["source"].get<double>() == doctest::Approx(-cause["source"].get<double>()));
      CHECK(one["removed"]["target"].get<double>() == doctest::Approx(-cause["target"].get<double>()));
    }
    CHECK(one["plus_one"]["source"].get<double>() == -one["minus_one"]["source"].get<double>());
  }
  // Residue 6 has one charge of +1 in its side chain, so that one more there doubles what it adds but for the backbone.
  for (const Json& one : scan["largest"]) {
    if (one["residue"] == "LYS 6")
      CHECK(one["plus_one"]["source"].get<double>() ==
            doctest::Approx(-one["removed"]["source"].get<double>()).epsilon(0.3));
  }
  REQUIRE(files.run(options).status == 0);
  CHECK_FALSE(files.json()["causes"][0].contains("scan"));
}

TEST_CASE("causes: side chains in other places give an interval, the same at each run") {
  const CausesFiles files;
  const std::string source = files.folder.write("long.pqr", files.with_lysine(0)),
                    target = files.folder.write("turned.pqr", files.with_lysine(1));
  for (const std::string potential : {"--potential pb --pb-spacing 0.8", "--potential coulomb"}) {
    const std::string command = "compare " + source + " " + target + " -o " + files.folder.file("out") +
                                " --domains none --exit-zero --overwrite --region '//A/3' --causes region "
                                "--causes whole --side-chains 200 " +
                                potential;
    const Outcome outcome = run_espdiff(command);
    REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const Json reading = files.json()["causes"][0], chains = reading["side_chains"];
    const bool is_exact = potential == "--potential coulomb";
    CHECK(chains["order"] == (is_exact ? "exact" : "first"));
    CHECK(contains(outcome.out, "with 1 side chain in other places (LYS 6)"));
    CHECK(contains(outcome.out, is_exact ? "exact at these points" : "to first order: the shape"));
    CHECK(chains["low"].get<double>() < chains["mean"].get<double>());
    CHECK(chains["mean"].get<double>() < chains["high"].get<double>());
    CHECK(chains["residues"].size() == 2);  // in both states
    CHECK_FALSE(files.json()["causes"][1].contains("side_chains"));
    const bool spans_zero = chains["low"] < 0 && chains["high"] > 0;
    CHECK(chains["spans_zero"] == spans_zero);
    CHECK(contains(outcome.out, "the sign of the difference is not known (region)") == spans_zero);
    // The file's own placement shifts nothing; the others do.
    const espdiff::CsvTable table = espdiff::read_csv(files.folder.file("out.side-chains.csv"));
    CHECK(table.number(0, table.rows[0].size() - 1) == 0);
    CHECK(table.number(1, table.rows[0].size() - 1) != 0);
    REQUIRE(run_espdiff(command).status == 0);
    CHECK(files.json()["causes"][0]["side_chains"] == chains);
    REQUIRE(run_espdiff(command + " --side-chain-seed 2").status == 0);
    CHECK(files.json()["causes"][0]["side_chains"] != chains);
  }
}

TEST_CASE("causes: contributions are a quantity of residues, of pairs and along frames") {
  const CausesFiles files;
  const std::string reading = " --potential coulomb --region '//A/1-3' --causes region ";
  const std::string pdb = files.folder.file("c.pdb"), quantity = " --residue-quantity contribution";
  REQUIRE(files.run(reading + "--residue-pdb " + pdb + quantity).status == 0);
  CHECK(contains(read_file(pdb), "B FACTOR: contribution [kT/e"));
  const espdiff::CsvTable of_pair = espdiff::read_csv(files.folder.file("out.causes.csv"));
  const std::string run = "trajectory " + files.source + " " + files.target + " " + files.source +
                          " --domains none -o " + files.folder.file("t.csv") + " --overwrite" + reading;
  const std::string table = files.folder.file("r.csv");
  const Outcome outcome = run_espdiff(run + "--residues " + table + quantity);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const espdiff::CsvTable frames = espdiff::read_csv(table);
  REQUIRE(frames.rows.size() == 2);
  const std::size_t difference = of_pair.columns.size() - 10;
  REQUIRE(contains(of_pair.columns[difference], "difference ["));
  for (std::size_t row = 0; row < of_pair.rows.size(); ++row) {
    const std::string residue = "A:" + of_pair.rows[row][4] + " " + of_pair.rows[row][2];
    const std::size_t column = frames.require(residue == "A:GLU 3" ? "A:SER 3" : residue);
    CHECK(frames.number(0, column) == doctest::Approx(of_pair.number(row, difference)).epsilon(1e-4));
    CHECK(std::fabs(frames.number(1, column)) < 1e-4);  // the source itself; charges make up to 80 kT/e
  }
  CHECK(contains(run_espdiff(run).err,
                 "--causes of a trajectory are written as a table of residues: give --residues "
                 "FILE and --residue-quantity contribution"));
  CHECK(contains(run_espdiff(run + "--causes whole --residues " + table + quantity).err,
                 "--causes: a trajectory has those of one reading"));
  CHECK(contains(run_espdiff(run + "--scan --residues " + table + quantity).err, "--scan is of one pair"));
  CHECK(contains(run_espdiff(run + "--side-chains 9 --residues " + table + quantity).err,
                 "--side-chains is of one pair"));
  const Outcome without = files.run("--potential coulomb --residue-pdb " + pdb + quantity);
  CHECK(without.status == 2);
  CHECK(contains(without.err, "contribution is what a residue adds to a reading: give --causes region"));
}

TEST_CASE("causes: a state compared with itself has none") {
  const CausesFiles files;
  const Outcome outcome =
      files.run("--potential pb --pb-spacing 0.8 --causes whole --causes 'residue 3'", files.source);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  for (const Json& reading : files.json()["causes"]) {
    CHECK(std::fabs(reading["difference"].get<double>()) < 1e-5);
    CHECK(std::fabs(reading["largest"][0]["difference"].get<double>()) <
          1e-5 * std::fabs(reading["largest"][0]["source"].get<double>()) + 1e-5);
  }
}

TEST_CASE("causes: what has none is refused in one line") {
  const CausesFiles files;
  const auto refused = [&](const std::string& options) {
    const Outcome outcome = files.run(options);
    CHECK(outcome.status == 2);
    CHECK(n_lines(outcome.err) <= 2);  // the second one of the parser: "Try ..."
    return outcome.err;
  };
  CHECK(contains(refused("--causes everything"), "--causes: 'everything' is not whole, region, patch NAME"));
  CHECK(contains(refused("--scan"), "--scan is of a reading: give --causes as well, such as --causes whole"));
  CHECK(contains(refused("--side-chains 5"), "--side-chains is of a reading: give --causes as well"));
  CHECK(contains(refused("--side-chains 5 --causes whole"),
                 "--side-chains is of a mean difference: give --causes region, a patch or a residue"));
  CHECK(contains(refused("--side-chains few --causes whole"),
                 "--side-chains: 'few' is not a whole number from 0 to 1000000"));
  CHECK(contains(refused("--causes region"), "--causes region needs a region: give --region or --region-within"));
  CHECK(contains(refused("--causes 'patch site'"), "there is no patch of that name; name a selection site by --patch"));
  CHECK(contains(refused("--causes 'residue B:3'"), "has no such residue"));
  CHECK(contains(refused("--potential pb --pb nonlinear --causes whole"),
                 "with the nonlinear Poisson-Boltzmann equation: its potential is not a sum over charges"));
  CHECK(contains(refused("--potential none --causes whole"), "--causes needs potentials that are computed"));
  const Outcome matrix = run_espdiff("matrix " + files.source + " " + files.target + " -o " + files.folder.file("m") +
                                     " --potential coulomb --causes whole");
  CHECK(matrix.status == 2);
  CHECK(contains(matrix.err, "--causes is of one pair, not of a matrix"));
}
