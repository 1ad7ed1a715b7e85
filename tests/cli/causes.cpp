// causes.cpp: --causes of `espdiff compare`: files, sums, what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_espdiff.h"
#include "io/read_csv.h"

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
  CHECK(contains(refused("--causes region"), "--causes region needs a region: give --region or --region-within"));
  CHECK(contains(refused("--causes 'patch site'"), "there is no patch of that name; give --patch site=SELECTION"));
  CHECK(contains(refused("--causes 'residue B:3'"), "has no such residue"));
  CHECK(contains(refused("--potential pb --pb nonlinear --causes whole"),
                 "with the nonlinear Poisson-Boltzmann equation: its potential is not a sum over charges"));
  CHECK(contains(refused("--potential none --causes whole"), "--causes needs potentials that are computed"));
  const Outcome matrix = run_espdiff("matrix " + files.source + " " + files.target + " -o " + files.folder.file("m") +
                                     " --potential coulomb --causes whole");
  CHECK(matrix.status == 2);
  CHECK(contains(matrix.err, "--causes is of one pair, not of a matrix"));
}
