// verify.cpp: `espdiff verify` agrees with 20 real comparisons, finds wrong numbers, and refuses damaged files.
#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "cli/bent_row.h"
#include "cli/small_result.h"

using namespace espdiff_test;

TEST_SUITE_BEGIN("verify");

TEST_CASE("20 real comparisons are verified") {
  const auto models = real_input("nmr/1l2y.pdb"), ph2 = real_input("pqr_pdb2pqr/1AJJ_pH2_AMBER.pqr"),
             ph7 = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr"), ph14 = real_input("pqr_pdb2pqr/1AJJ_pH14_AMBER.pqr"),
             m00 = real_input("series19_ubq_2k39/m00.pqr"), m18 = real_input("series19_ubq_2k39/m18.pqr"),
             hiv = real_input("pairs/1hhp.pdb"), other_hiv = real_input("pairs/3phv.pdb"),
             aaf = real_input("pairs/1aaf.pdb"), tim = real_input("pair_tim_maps/scTIM_chainA.pqr"),
             mutant = real_input("pair_tim_maps/dTIM_chainA.pqr");
  if (!models || !ph2 || !ph7 || !ph14 || !m00 || !m18 || !hiv || !other_hiv || !aaf || !tim || !mutant) return;
  std::vector<std::string> pairs;
  for (const char* const options : {"2", "9 --method deform", "17", "23 --align backbone", "31", "38 --domains auto"})
    pairs.push_back(*models + " " + *models + " --potential none --target-model " + options);
  pairs.push_back(*models + " " + *models + " --source-model 7 --target-model 21 --potential none --cavities");
  pairs.push_back(*models + " " + *models + " --source-model 3 --target-model 30 --potential none --grid-spacing 0.7");
  for (const char* const options : {"", "--method deform", "--offset 1.4", "--offset 0,3"}) {
    pairs.push_back(*ph2 + " " + *ph7 + " --potential coulomb " + options);
    pairs.push_back(*ph14 + " " + *ph7 + " --potential coulomb " + options);
  }
  pairs.push_back(*m00 + " " + *m18 + " --potential coulomb");                 // little of some residues is trusted
  pairs.push_back(*aaf + " " + *aaf + " --target-model 10 --potential none");  // far, mapped twice, not trustworthy
  pairs.push_back(*hiv + " " + *other_hiv + " --potential none");
  pairs.push_back(*tim + " " + *mutant + " --source-map " + *real_input("pair_tim_maps/scTIM_chainA_pot-PE0.dx") +
                  " --target-map " + *real_input("pair_tim_maps/dTIM_chainA_pot-PE0.dx") +
                  " --source-map-unit kT/e --target-map-unit kT/e");
  CHECK(pairs.size() == 20);
  const ScratchFolder folder;
  const std::string prefix = folder.file("result");
  for (const std::string& pair : pairs) {
    CAPTURE(pair);
    const Outcome compared = run_espdiff("compare " + pair + " -q --exit-zero --overwrite -o " + prefix);
    REQUIRE(compared.status == 0);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CAPTURE(verified.err);
    CHECK(verified.status == 0);
    CHECK(contains(verified.out, "\nVERIFIED: "));
    CHECK_FALSE(contains(verified.out, "DIFFERS"));
  }
}

TEST_CASE("coarse lattices are verified: tolerances follow from the spacing") {
  const ScratchFolder folder;
  write_file(folder.file("a.pqr"), bent_row(0, 12));
  write_file(folder.file("b.pqr"), bent_row(0.6, 12));
  for (const char* const spacing : {"0.7", "1.5", "1.8"}) {
    const std::string prefix = folder.file(std::string("s") + spacing);
    REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file("b.pqr") +
                        " --potential none --device cpu -q --grid-spacing " + spacing + " -o " + prefix)
                .status == 0);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CHECK(verified.status == 0);
  }
}

TEST_CASE("a state against itself differs by rounding, nearly the same one by noise; neither has a correlation") {
  const ScratchFolder folder;
  const std::string row = bent_row(0, 12);
  std::string nearly = row;
  nearly.replace(nearly.find("-0.7000"), 7, "-0.7003");
  write_file(folder.file("a.pqr"), row);
  write_file(folder.file("b.pqr"), nearly);
  for (const bool is_same : {true, false}) {
    const std::string prefix = folder.file(is_same ? "self" : "nearly");
    REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file(is_same ? "a.pqr" : "b.pqr") +
                        " --potential coulomb --device cpu -q --exit-zero -o " + prefix)
                .status == 0);
    const std::string json = read_file(prefix + ".json");
    CHECK(contains(json,
                   "source and target have the same atoms at the same places with the same charges: every "
                   "difference is zero but for rounding") == is_same);
    CHECK(contains(json, "noise with noise") != is_same);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CHECK(verified.status == 0);
  }
}

TEST_CASE("fields have units of their own, which their columns must have") {
  const ScratchFolder folder;
  write_file(folder.file("a.pqr"), bent_row(0, 12));
  write_file(folder.file("b.pqr"), bent_row(0.6, 12));
  const std::string prefix = folder.file("r");
  REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file("b.pqr") +
                      " --potential coulomb --field charge --field curvature -q --exit-zero -o " + prefix)
              .status == 0);
  const Outcome verified = run_espdiff("verify " + prefix);
  CHECK_MESSAGE(verified.status == 0, verified.out);
  std::string table = read_file(prefix + ".residues.csv");
  const std::string column = "curvature_mean_source [1/A]";
  REQUIRE(contains(table, column));
  write_file(prefix + ".residues.csv", table.replace(table.find(column), column.size(), "curvature_mean_source [e]"));
  const Outcome wrong = run_espdiff("verify " + prefix);
  CHECK(wrong.status == 1);
  CHECK_MESSAGE(contains(wrong.out, "columns of other units than OUT.json has"), wrong.out);
  CHECK(contains(wrong.out, "NOT VERIFIED: 1 of "));
}

TEST_CASE("a result of three atoms is verified, whose surface has no hollows") {
  const ScratchFolder folder;
  const std::string atoms =
      "ATOM 1 CA ALA A 1 0 0 0 0.5 1.2\nATOM 2 CA ALA A 2 1 0.7 0.4 0.5 1.2\nATOM 3 CA ALA A 3 2 1.4 0 0.5 1.2\n";
  write_file(folder.file("a.pqr"), atoms);
  for (const char* const spacing : {"1", "1.5", "2"}) {
    const std::string prefix = folder.file(std::string("s") + spacing);
    REQUIRE(run_espdiff("compare " + folder.file("a.pqr") + " " + folder.file("a.pqr") +
                        " --potential coulomb --device cpu -q --exit-zero --grid-spacing " + spacing + " -o " + prefix)
                .status == 0);
    const Outcome verified = run_espdiff("verify " + prefix);
    CAPTURE(verified.out);
    CHECK(verified.status == 0);
  }
}

TEST_CASE("a wrong number in OUT.vtp or OUT.residues.csv is found") {
  const SmallResult result;
  if (result.prefix.empty()) return;
  const std::string right = read_file(result.prefix + ".vtp");
  // The arrays stand in binary, one after the other, each behind its length.
  const std::size_t data = right.find("encoding=\"raw\"");
  REQUIRE(data != std::string::npos);
  const auto offset_of = [&](const std::string& name) {
    const std::size_t at = right.find("Name=\"" + name + "\"");
    return right.find('_', data) + 1 + 8 + std::stoul(right.substr(right.find("offset=\"", at) + 8));
  };
  const auto with_number = [&](const std::string& array, std::size_t place, float value) {
    std::string text = right;
    std::memcpy(&text[offset_of(array) + place * sizeof value], &value, sizeof value);
    write_file(result.prefix + ".vtp", text);
    return result.verified();
  };
  Outcome verified = with_number("slip", 100, 50.0F);
  CAPTURE(verified.out);
  CHECK(verified.status == 1);
  CHECK(differs(verified, "certificate/slip/max_A"));
  verified = with_number("displacement", 100, 4.5F);
  CHECK(differs(verified, "displacement at the vertices, largest deviation"));
  std::string text = right;
  const double away = 100;
  std::memcpy(&text[offset_of("Points") + 24 * 100], &away, sizeof away);  // one vertex lies elsewhere
  write_file(result.prefix + ".vtp", text);
  verified = result.verified();
  CHECK(verified.status == 1);
  CHECK(differs(verified, "area_A2/mapped"));
  CHECK(differs(verified, "certificate/mapped_to_target_A/max"));

  write_file(result.prefix + ".vtp", right);
  const std::string path = result.prefix + ".residues.csv";
  std::string table = read_file(path);
  const std::size_t second_row = table.find('\n') + 1, area = table.find("ASN,", second_row) + 4;
  table.insert(area, "9");
  write_file(path, table);
  CHECK(differs(result.verified(), "OUT.residues.csv, area"));
}

TEST_CASE("damaged results are refused with the file and the remedy") {
  const SmallResult result;
  if (result.prefix.empty()) return;
  const std::string json = result.prefix + ".json", vtp = result.prefix + ".vtp";
  const std::string right = read_file(json), surface = read_file(vtp);
  const auto refused = [&](const std::string& text) {
    const Outcome verified = result.verified();
    CAPTURE(verified.err);
    CHECK(verified.status == 2);
    CHECK(contains(verified.err, text));
    CHECK(n_lines(verified.err) == 1);
  };
  write_file(json, right.substr(0, right.size() / 2));
  refused(json + ": is not JSON, or is cut off; compare again");
  write_file(json, "[1, 2]");
  refused(json + ": is not the record of a comparison: it has no certificate, or no inputs; compare again");
  write_file(json, R"({"certificate": {}, "inputs": {}})");
  refused(json + ": is not the record of a comparison: it has no certificate, or no inputs; compare again");
  write_file(json, right);
  result.set("/superposition/paired_atoms", OrderedJson::array({OrderedJson::array({0, 0, 100000})}));
  refused(json + ": superposition/paired_atoms names atoms that the structures lack; compare again");
  result.set("/superposition/paired_atoms", OrderedJson::array({OrderedJson::array({0, -1, 2})}));
  refused(json + ": superposition/paired_atoms has an entry that is not three whole numbers; compare again");
  write_file(json, right);
  result.set("/inputs/0/sha256", "abc");
  refused("has changed since the comparison; compare again");
  write_file(json, right);

  std::string without_slip = surface;
  without_slip.replace(without_slip.find("Name=\"slip\""), 11, "Name=\"slap\"");
  write_file(vtp, without_slip);
  refused(vtp + ": has no array \"slip\", which a comparison writes; compare again");
  write_file(vtp, surface.substr(0, surface.size() / 2));
  refused(vtp);
  write_file(vtp, surface);
  CHECK(result.verified().status == 0);

  for (const char* place : {"/inputs/0/path", "/inputs/1/path"}) result.set(place, "");
  const Outcome without_files = result.verified();
  CHECK_MESSAGE(without_files.status == 0, without_files.err);
  CHECK_MESSAGE(contains(without_files.out, "OUT.json names no file for the source"), without_files.out);
  const Outcome exported = run_espdiff("export " + json + " --to pdb -o " + result.folder.file("x.pdb"));
  CHECK(exported.status == 2);
  CHECK_MESSAGE(contains(exported.err, json + ": names no file of a structure; compare again, or export"),
                exported.err);
  write_file(json, right);

  const Outcome absent = run_espdiff("verify " + result.folder.file("nothing"));
  CHECK(absent.status == 2);
  CHECK(contains(absent.err, "give the prefix of a result: OUT of OUT.json and OUT.vtp"));
}

TEST_SUITE_END();
