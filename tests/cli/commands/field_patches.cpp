// field_patches.cpp: --patches-of and `espdiff complementarity` on the command line: files, words, and what is refused.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

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

TEST_CASE("compare has the complementarity of both states, and its change by place and residue") {
  const ScratchFolder folder;
  const std::string source = folder.write("source.pqr", two_rows(4.2)),
                    target = folder.write("target.pqr", two_rows(4.6)), out = folder.file("out");
  const std::string usual = "compare " + source + " " + target + " --pb-spacing 1 --exit-zero --no-trials -o " + out;
  const Outcome outcome = run_espdiff(usual + " --interface A:B");
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "Complementarity "));
  CHECK(contains(outcome.out, " of A and B; Spearman "));
  const auto json = nlohmann::json::parse(read_file(out + ".json"));
  const auto& interface = json["interface"];
  // The verb measures the same, on its own.
  const Outcome verb = run_espdiff("complementarity " + source + " " + target + " --interface A:B --pb-spacing 1 -o " +
                                   folder.file("verb"));
  REQUIRE_MESSAGE(verb.status == 0, verb.err);
  const auto of_verb = nlohmann::json::parse(read_file(folder.file("verb.json")));
  for (const char* state : {"source", "target"}) {
    for (const char* number : {"pearson", "spearman"}) CHECK(interface[state][number] == of_verb[state][number]);
  }
  CHECK(interface["change"] == of_verb["change"]);
  // The first partner alone is compared; the field's mean is its side of the number.
  const auto residues = espdiff::read_csv(out + ".residues.csv");
  CHECK(residues.rows.size() == 6);
  const auto& field = json["fields"]["complementarity"];
  CHECK(field["area_A2"].get<double>() > 20);
  CHECK(field["correlation"].get<double>() > 0.9);
  const auto rows = espdiff::read_csv(out + ".interface.csv");
  CHECK(read_file(out + ".interface.csv") == read_file(folder.file("verb.interface.csv")));
  const std::size_t change = rows.require("change_of_contribution");
  double sum = 0;
  for (std::size_t r = 0; r < rows.rows.size(); ++r) sum += rows.number(r, change) / 2;
  CHECK(sum == doctest::Approx(interface["change"]["pearson"].get<double>()).scale(1).epsilon(1e-4));
  const auto vtp = espdiff::read_vtp(out + ".vtp");
  for (const char* array : {"complementarity_source", "complementarity_target", "complementarity_difference"})
    CHECK(espdiff::find_array(vtp.point_arrays, array) != nullptr);
  CHECK(contains(run_espdiff("show " + out).out, "Electrostatic complementarity of A and B"));
  // The same with the partners exchanged: both numbers are means of both sides.
  REQUIRE(run_espdiff(usual + " --interface B:A --overwrite").status == 0);
  const auto exchanged = nlohmann::json::parse(read_file(out + ".json"));
  CHECK(exchanged["interface"]["source"]["pearson"].get<double>() ==
        doctest::Approx(interface["source"]["pearson"].get<double>()).epsilon(1e-6));
}

TEST_CASE("an interface that cannot be is refused in one line") {
  const ScratchFolder folder;
  const std::string file = folder.write("complex.pqr", two_rows(4.2)), apart = folder.write("apart.pqr", two_rows(30));
  for (const auto& [arguments, text] : std::vector<std::pair<std::string, std::string>>{
           {file + " " + file + " --interface A",
            "--interface: 'A' does not name two partners; write chains, such as H,L:A"},
           {file + " " + file + " --interface A:X",
            "--interface: 'X' selects no atom; " + file + " has chain A (ALA), chain B (ALA)"},
           {file + " " + file + " --interface A:A,B", "belongs to both partners; name two that share no atom"},
           {file + " " + file + " --interface A:B --potential none",
            "--interface A:B: complementarity needs potentials of each partner, leave out --potential none"},
           {file + " " + apart + " --interface A:B", "--interface A:B: in " + apart + " the partners bury no surface"},
           {file + " " + file + " --field complementarity",
            "--field complementarity: it is made of two partners in a comparison of two complexes, which --interface "
            "A:B "
            "names"},
           {file + " " + file + " --interface A:B --field complementarity=charge",
            "two fields are called 'complementarity'"}}) {
    const Outcome outcome = run_espdiff("compare " + arguments + " -o " + folder.file("none"));
    CHECK(outcome.status == 2);
    CHECK_MESSAGE(contains(outcome.err, text), outcome.err);
  }
  CHECK(contains(run_espdiff("matrix " + file + " " + apart + " --interface A:B -o " + folder.file("m")).err,
                 "--interface"));
}

TEST_SUITE_END();
