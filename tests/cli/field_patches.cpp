// field_patches.cpp: --patches-of and `espdiff complementarity` on the command line: files, words, and what is refused.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/bent_row.h"
#include "cli/run_espdiff.h"
#include "io/files/read_csv.h"
#include "io/vtk/read_vtp.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Two rows of charged atoms, chains A and B, `gap_A` apart.
std::string two_rows(double gap_A) {
  std::string text;
  for (int i = 0; i < 12; ++i) {
    const bool is_second = i >= 6;
    char line[128];
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA %c%4d    %8.3f%8.3f%8.3f %7.4f %6.4f\n", i + 1,
                  is_second ? 'B' : 'A', i % 6 + 1, 3.0 * (i % 6) + 0.3 * (i % 2), is_second ? gap_A : 0.0,
                  0.2 * (i % 3), (i % 6 < 3) == is_second ? -0.4 : 0.5, 2.0);
    text += line;
  }
  return text;
}

}  // namespace

TEST_SUITE_BEGIN("cli field patches");

TEST_CASE("patches have a table, rows in OUT.json, arrays and a line") {
  const ScratchFolder folder;
  const std::string a = folder.write("a.pqr", bent_row(0)), b = folder.write("b.pqr", bent_row(0.3)),
                    out = folder.file("out");
  const Outcome outcome =
      run_espdiff("compare " + a + " " + b +
                  " --potential none --field charge --patches-of 'charge>-5' --exit-zero --no-trials "
                  "-o " +
                  out);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "Patches of charge"));
  const auto json = nlohmann::json::parse(read_file(out + ".json"));
  REQUIRE(json["field_patches"].size() == 1);
  const auto& patches = json["field_patches"][0];
  CHECK(patches["field"] == "charge");
  CHECK(patches["above"] == -5);
  CHECK(patches["below"].is_null());
  REQUIRE(!patches["patches"].empty());
  CHECK(patches["patches"][0]["area_A2"].get<double>() > 100);  // all of the surface
  CHECK(patches["patches"][0]["extreme"].get<double>() >= patches["patches"][0]["mean"].get<double>());
  const auto csv = espdiff::read_csv(out + ".field_patches.csv");
  CHECK(csv.rows.size() == patches["patches"].size());
  CHECK(csv.columns[5] == "area_A2");
  const auto vtp = espdiff::read_vtp(out + ".vtp");
  CHECK(espdiff::find_array(vtp.point_arrays, "charge_patch_source") != nullptr);
  CHECK(espdiff::find_array(vtp.point_arrays, "charge_patch_target") != nullptr);
  CHECK(json["options"]["patches_of"] == "charge>-5");
}

TEST_CASE("patches of what is not compared are refused before the work") {
  const ScratchFolder folder;
  const std::string a = folder.write("a.pqr", bent_row(0));
  const Outcome outcome = run_espdiff("compare " + a + " " + a + " --patches-of 'charge>1' -o " + folder.file("out"));
  CHECK(outcome.status == 2);
  CHECK(contains(outcome.err,
                 "--patches-of 'charge>1': the field 'charge' is not compared; give --field charge as well"));
}

TEST_CASE("complementarity has numbers, residues that add up to them, and surfaces") {
  const ScratchFolder folder;
  const std::string complex = folder.write("complex.pqr", two_rows(4.2)), out = folder.file("out");
  const std::string usual = " --interface A:B --pb-spacing 1 -o " + out;
  const Outcome outcome = run_espdiff("complementarity " + complex + usual);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto json = nlohmann::json::parse(read_file(out + ".json"));
  const double expected = json["source"]["first"]["pearson"];
  CHECK(expected > 0.5);  // opposite charges face each other
  CHECK(contains(outcome.out, "complementarity "));
  const auto csv = espdiff::read_csv(out + ".interface.csv");
  const std::size_t contribution = csv.require("contribution");
  double sum = 0;
  for (std::size_t r = 0; r < csv.rows.size(); ++r) sum += csv.rows[r][0] == "A" ? csv.number(r, contribution) : 0;
  CHECK(sum == doctest::Approx(expected).epsilon(1e-4));
  CHECK(espdiff::find_array(espdiff::read_vtp(out + ".first.vtp").point_arrays, "complementarity") != nullptr);
  CHECK(run_espdiff("complementarity " + complex + usual).status == 2);  // without --overwrite
  const std::string apart = folder.write("apart.pqr", two_rows(30));
  const Outcome refused = run_espdiff("complementarity " + apart + " --interface A:B -o " + folder.file("none"));
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "--interface A:B: in " + apart + " the partners bury no surface in each other"));
}

TEST_SUITE_END();
