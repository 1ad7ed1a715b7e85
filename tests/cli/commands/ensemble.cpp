// ensemble.cpp: `espdiff ensemble`: groups, lists, charges, kills, shards, and what is refused.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/linked_outputs.h"
#include "cli/run_espdiff.h"
#include "io/frames/made_dcd.h"
#include "io/frames/molfile_plugins.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

constexpr int kAtoms = 8, kFrames = 4;

/// A bent row of atoms that wriggles with the frame; the mutant's last atom has another charge.
std::string models(int replicate, bool mutant, bool with_charges) {
  std::string text;
  for (int f = 0; f < kFrames; ++f) {
    text += "MODEL     " + std::to_string(f + 1) + "\n";
    for (int i = 0; i < kAtoms; ++i) {
      const double x = 2.4 * i, y = 0.3 * std::sin(1.7 * i + f + 3 * replicate), z = 0.3 * std::cos(2.3 * i * (f + 1));
      char line[128];
      if (with_charges) {
        std::snprintf(line, sizeof line, "ATOM %d CA ALA A %d %.3f %.3f %.3f %.4f 2.2\n", i + 1, i + 1, x, y, z,
                      mutant && i == kAtoms - 1 ? -1.0 : 0.2);
      } else {
        std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1,
                      i + 1, x, y, z);
      }
      text += line;
    }
    text += "ENDMDL\n";
  }
  return text;
}

/// Two groups of four replicates.
struct Runs {
  ScratchFolder folder;
  std::string groups = "--group wild", mutants = " --group mutant";
  int n_threads = 1;
  Runs() {
    for (int r = 1; r <= 4; ++r) {
      folder.write("w" + std::to_string(r) + ".pqr", models(r, false, true));
      folder.write("m" + std::to_string(r) + ".pqr", models(r + 4, true, true));
      groups += " w" + std::to_string(r) + ".pqr";
      mutants += " m" + std::to_string(r) + ".pqr";
    }
    groups += mutants;
  }
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    return run_espdiff(arguments + " --device cpu --threads " + std::to_string(n_threads),
                       "cd " + folder.file("") + " && " + before);
  }
  /// Verbs that take no device.
  Outcome read(const std::string& arguments, const std::string& before = "") const {
    return run_espdiff(arguments, "cd " + folder.file("") + " && " + before);
  }
  Outcome merge(const std::string& arguments, const std::string& before = "") const {
    return read("merge " + arguments, before);
  }
  Outcome run_merge() const {
    return merge("part.shard-1-of-3.h5 part.shard-2-of-3.h5 part.shard-3-of-3.h5 -q -o all");
  }
  Outcome from(const std::string& name) const { return run("ensemble --from " + name + ".h5 -q -o " + name); }
  /// An ensemble on a coarse grid, quickly.
  Outcome ensemble(const std::string& arguments, const std::string& before = "") const {
    return run("ensemble --grid-spacing 1.5 --potential coulomb " + arguments, before);
  }
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

TEST_CASE("the mutant's charge is found at the mutant's residue, with its sign") {
  const Runs in;
  const Outcome out = in.ensemble(in.groups + " -o out");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(out.out.find("labels exchanged in all 70 ways") != std::string::npos);
  CHECK(out.err.empty());
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  CHECK(json["potential_unit"] == "kT/e in vacuum");
  CHECK(contains(json["conclusion"].get<std::string>(), " kT/e in vacuum ("));
  CHECK(contains(out.out, "diff. (kT/e)"));
  REQUIRE(!json.at("patches").empty());
  CHECK(json["patches"][0]["difference"].get<double>() < 0);
  bool at_mutant = false;
  for (const auto& residue : json["patches"][0]["residues"]) at_mutant |= residue["residue"] == "ALA 8 of chain A";
  CHECK(at_mutant);
  for (const char* ending : {".vtp", ".h5", ".residues.csv", ".patches.csv", ".patch_series.csv"})
    CHECK(std::filesystem::exists(in.folder.file(std::string("out") + ending)));
}

TEST_CASE("the mutant's charge makes the difference of a patch, fixed or found, with an interval by replicate") {
  const Runs in;
  const std::string run = in.groups + " --patch end=//A/7-8 -o out";
  REQUIRE(in.ensemble(run).status == 0);
  // The complete file gets causes: frames are solved again, none is mapped anew.
  const Outcome out = in.ensemble(run + " --resume --causes 'patch end' --causes 'patch 1'");
  REQUIRE_MESSAGE(out.status == 0, out.err);
  CHECK(contains(out.out, "0 frames mapped"));
  CHECK(contains(out.out, "whose charges make the difference of patch end"));
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  REQUIRE(json["causes"].size() == 2);
  for (const auto& reading : json["causes"]) {
    CAPTURE(reading["reading"]);
    CHECK(reading["n_frames"] == 8 * kFrames);
    CHECK(reading["largest_deviation_of_sum"].get<double>() < 1e-4);
    const auto& largest = reading["largest"][0];
    CHECK(largest["residue"] == "ALA 8 of chain A");
    CHECK(largest["low"].get<double>() < largest["difference"].get<double>());
    CHECK(largest["high"].get<double>() < 0);
    CHECK(largest["p_false_discovery"].get<double>() < 0.05);
  }
  // The contributions' sums are the patches' means.
  for (const char* group : {"wild", "mutant"})
    CHECK(json["causes"][0]["means"][group].get<double>() ==
          doctest::Approx(json["fixed_patches"]["end"]["means"][group].get<double>()).epsilon(1e-3));
  const std::string table = read_file(in.folder.file("out.causes.csv"));
  CHECK(contains(first_line(table), "reading,residue,mean_wild,mean_mutant,difference,low,high,t,p,p_false_discovery"));
  const auto refused = [&](const std::string& options) { return in.ensemble(in.groups + " -o other " + options).err; };
  CHECK(contains(refused("--causes whole"),
                 "--causes whole: an ensemble's causes are of a patch; give --causes 'patch NAME'"));
  CHECK(contains(refused("--scan --causes 'patch 1'"), "--scan is of one pair, not of an ensemble"));
  CHECK(contains(refused("--causes 'patch lid'"),
                 "--causes 'patch lid': there is no patch of that name; name a selection lid by --patch"));
}

TEST_CASE("a complete file gets causes: its frames are read again, and must be those that were mapped") {
  const Runs in;
  REQUIRE(in.ensemble(in.groups + " --patch 'end=//A/6-8' --causes 'patch 1' -q -o out").status == 0);
  const auto again = [&](const std::string& options) { return in.run("ensemble --from out.h5 -o again " + options); };
  const std::string expected = read_file(in.folder.file("out.causes.csv"));
  const Outcome same = again("--causes 'patch 1'");
  REQUIRE_MESSAGE(same.status == 0, same.err);
  CHECK(contains(same.err, "the causes solve " + std::to_string(8 * kFrames) + " frames again, in about "));
  CHECK(read_file(in.folder.file("again.causes.csv")) == expected);
  // Frames keep their files when replicates are chosen in another order.
  const Outcome chosen =
      again("--group mutant m2 m1 --group wild w1 w3 -q --overwrite --patch 'end=//A/6-8' --causes 'patch end'");
  CHECK_MESSAGE(chosen.status == 0, chosen.err);
  CHECK(contains(again("--causes whole").err, "an ensemble's causes are of a patch"));
  CHECK(contains(again("--causes 'patch 1' --scan").err, "--scan is of one pair, not of an ensemble"));
  in.folder.write("m2.pqr", models(9, true, true));
  CHECK(contains(again("--causes 'patch 1'").err,
                 "--causes solves the frames of out.h5 again, and they are others now: the content of replicate m2 of "
                 "mutant has changed; put back what was mapped, or map again without --from"));
  std::filesystem::remove(in.folder.file("m2.pqr"));
  CHECK(contains(again("--causes 'patch 1'").err,
                 "--causes solves the frames of out.h5 again, and m2.pqr (replicate m2 of mutant) is not there; start "
                 "in the folder in which they were mapped, or put the file back"));
}

TEST_CASE("kill -9 at any time: the run resumes to the same bytes, by several threads too; shards merge to them") {
  Runs in;
  const std::string run = in.groups + " -q -o ";
  REQUIRE(in.ensemble(run + "whole").status == 0);
  const std::string expected = read_file(in.folder.file("whole.h5"));
  int n_killed = 0;
  for (int i = 0; i < 10; ++i) {
    in.n_threads = i % 2 == 0 ? 3 : 1;
    char delay[32];
    std::snprintf(delay, sizeof delay, "timeout -s KILL %.2f ", 0.15 + 0.1 * i);
    n_killed += in.ensemble(run + "killed --resume", delay).status != 0 ? 1 : 0;
  }
  CHECK(n_killed > 0);
  REQUIRE(in.ensemble(run + "killed --resume").status == 0);
  CHECK(read_file(in.folder.file("killed.h5")) == expected);
  for (const char* ending : {".json", ".vtp", ".residues.csv", ".patches.csv", ".patch_series.csv"})
    CHECK(read_file(in.folder.file(std::string("killed") + ending)) ==
          read_file(in.folder.file(std::string("whole") + ending)));

  for (const char* shard : {"1", "2", "3"}) {
    INFO(shard);
    REQUIRE(in.ensemble(in.groups + " -q -o part --shard " + shard + "/3").status == 0);
  }
  const Outcome merged = in.run_merge();
  INFO(merged.err);
  REQUIRE(merged.status == 0);
  CHECK(read_file(in.folder.file("all.h5")) == expected);
  REQUIRE(in.from("all").status == 0);
  CHECK(read_file(in.folder.file("all.json")) == read_file(in.folder.file("whole.json")));
}

TEST_CASE("frames that are mapped beside each other: the bytes, the causes and the errors of one after the other") {
  Runs in;
  // The third frame of a replicate has no surface: its atoms are apart from each other by more than a grid may have.
  std::string apart = models(2, false, true);
  const std::size_t model = apart.find("MODEL     3"), atom = apart.find(" 2.400 ", model);
  REQUIRE(atom != std::string::npos);
  apart.replace(atom, 7, " 9.0e8 ");
  const std::string run = in.groups + " --patch end=//A/7-8 --causes 'patch end' -q --overwrite -o ";
  const auto bytes_of = [&](const std::string& name) {
    std::string all;
    for (const char* ending : {".h5", ".json", ".causes.csv", ".residues.csv"})
      all += read_file(in.folder.file(name + ending));
    return all;
  };
  std::string errors[2], bytes[2], whole[2];
  for (const int i : {0, 1}) {
    in.n_threads = i == 0 ? 1 : 3;
    in.folder.write("w2.pqr", models(2, false, true));
    REQUIRE(in.ensemble(run + "out").status == 0);
    whole[i] = bytes_of("out");
    in.folder.write("w2.pqr", apart);
    const Outcome stopped = in.ensemble(run + "stopped");
    CHECK(stopped.status != 0);
    errors[i] = stopped.err;
    const Outcome skipped = in.ensemble(run + "skipped --on-error skip");
    REQUIRE_MESSAGE(skipped.status == 0, skipped.err);
    bytes[i] = bytes_of("skipped");
  }
  CHECK(contains(errors[0], "wild, replicate w2, frame 2: "));
  CHECK(errors[0] == errors[1]);
  CHECK(whole[0] == whole[1]);
  CHECK(bytes[0] == bytes[1]);
}

TEST_CASE("fields have results of their own: found where they differ, resumed, sharded and computed again") {
  const Runs in;
  const std::string fields = " --field e=normal-field --field curvature --field charge";
  REQUIRE(in.ensemble(in.groups + " -q -o plain").status == 0);
  const Outcome out = in.ensemble(in.groups + fields + " -o out");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(read_file(in.folder.file("out.h5")) == read_file(in.folder.file("plain.h5")));
  CHECK(out.out.find("family       p is family-wise over the surfaces of 2 fields together") != std::string::npos);
  CHECK(out.out.find("warning: field charge was not tested: values of replicate w1 of wild do not change") !=
        std::string::npos);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.e.json")));
  double at_mutant = 0;
  for (const auto& patch : json.at("patches")) {
    for (const auto& residue : patch.at("residues"))
      if (residue.at("residue") == "ALA 8 of chain A") at_mutant = patch.at("difference").get<double>();
  }
  CHECK(at_mutant < 0);  // the field points into a charge that became negative
  CHECK(json["field"]["kind"] == "normal-field");
  CHECK(json["field"]["n_together"] == 2);
  CHECK(read_file(in.folder.file("out.e.vtp")).find("\"e_difference\"") != std::string::npos);
  CHECK(nlohmann::json::parse(read_file(in.folder.file("out.curvature.json"))).at("patches").empty());

  in.ensemble(in.groups + fields + " -q -o killed", "timeout -s KILL 0.6 ");
  REQUIRE(in.ensemble(in.groups + fields + " -q -o killed --resume").status == 0);
  for (const char* shard : {"1", "2", "3"})
    REQUIRE(in.ensemble(in.groups + fields + " -q -o part --shard " + shard + "/3").status == 0);
  REQUIRE(in.run_merge().status == 0);
  for (const char* name : {"e", "curvature", "charge"}) {
    const std::string part = std::string("part.") + name + ".shard-";
    REQUIRE(in.merge(part + "1-of-3.h5 " + part + "2-of-3.h5 " + part + "3-of-3.h5 -q -o all." + name).status == 0);
  }
  REQUIRE(in.run("ensemble --from all.h5 -q -o all" + fields).status == 0);
  for (const char* name : {"killed", "all"}) {
    for (const char* ending : {".h5", ".json", ".vtp", ".residues.csv", ".patches.csv"})
      CHECK(read_file(in.folder.file(name + std::string(".e") + ending)) ==
            read_file(in.folder.file(std::string("out.e") + ending)));
  }
  const Outcome missing = in.run("ensemble --from all.h5 -q -o all --field donor");
  CHECK(missing.status == 2);
  CHECK(missing.err ==
        "espdiff: all.donor.h5: no such file; --from all.h5 with --field donor reads the field's values "
        "there, and only a run that maps makes it\n");
  const Outcome plot = in.read("plot out.e -o bars.svg");
  REQUIRE_MESSAGE(plot.status == 0, plot.err);
  const std::string picture = read_file(in.folder.file("bars.svg"));
  CHECK(contains(picture, "mutant - wild, mean e of each residue"));
  CHECK(contains(picture, "ALA 8 of chain A"));
  CHECK(in.read("plot out.e.residues.csv --kind scatter -o scatter.svg").status == 0);
  const Outcome verify = in.read("verify out.e");
  CHECK(verify.status == 2);
  CHECK_MESSAGE((contains(verify.err,
                          "out.e.json: is the record of an ensemble, and `verify` recomputes comparisons of two "
                          "states. `ensemble` with --from OUT.h5 checks the sum of each frame") ||
                 contains(verify.err, "this build cannot verify")),
                verify.err);
  const Outcome no_pattern = in.ensemble(in.groups + " --field water=map:w.dx -q -o none");
  CHECK(no_pattern.status != 0);
  CHECK(no_pattern.err.find('\n') == no_pattern.err.size() - 1);
}

TEST_CASE("the answer through the medoids of the groups is beside that of the first template") {
  const Runs in;
  const Outcome out = in.ensemble(in.groups + " -o out --check-template");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(contains(out.out, "through another template"));
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  const auto& checks = json.at("template_check");
  REQUIRE(checks.size() == 2);
  for (const auto& check : checks) {
    CHECK(check.at("overlap").get<double>() > 0.3);
    CHECK(check.at("patch_differences").at(0).get<double>() ==
          doctest::Approx(json.at("patches").at(0).at("difference").get<double>()).epsilon(0.2));
  }
  CHECK(contains(checks[1].at("template").get<std::string>(), "medoid of mutant"));
  CHECK(contains(in.ensemble(in.groups + " -o out2 --shard 1/2 --check-template").err, "in one process; leave it out"));
}

TEST_CASE("a patch that was chosen beforehand has its means, its difference and its own p") {
  const Runs in;
  REQUIRE(in.ensemble(in.groups + " -q -o out --patch site=//A/8 --patch far-end=//A/1-2").status == 0);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  REQUIRE(json.at("fixed_patches").size() == 2);
  const auto& site = json["fixed_patches"]["site"];
  CHECK(site.at("difference").get<double>() ==
        doctest::Approx(site["means"]["mutant"].get<double>() - site["means"]["wild"].get<double>()));
  CHECK(site.at("p").get<double>() < 0.001);
  CHECK(site.at("high").get<double>() < 0);
  CHECK(json["fixed_patches"]["far-end"].at("area_A2").get<double>() > 100);
  // What is measured changes no frame: the same file continues.
  CHECK(in.ensemble(in.groups + " -q -o out --resume --patch other=//A/3").status == 0);
  // The file knows the template's residues.
  REQUIRE(in.ensemble("--from out.h5 -q -o again --patch site=//A/8").status == 0);
  const auto again = nlohmann::json::parse(read_file(in.folder.file("again.json")));
  CHECK(again["fixed_patches"]["site"] == site);
  const std::string atoms = in.ensemble("--from out.h5 -q -o again2 --patch site=//A/8/CB").err;
  CHECK_MESSAGE(contains(atoms, "the template (its residues alone, as CA atoms): --patch '//A/8/CB' selects no atom"),
                atoms);
  CHECK(contains(in.ensemble(in.groups + " -o out3 --patch site").err, "is not NAME=SELECTION"));
  CHECK(contains(in.ensemble(in.groups + " -o out3 --patch site=//Z").err, "Z"));
}

TEST_CASE("a patch of an earlier result is measured in every command, and says how its place was found") {
  const Runs in;
  REQUIRE(in.ensemble(in.groups + " -q -o out").status == 0);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  REQUIRE(!json.at("patches").empty());
  const auto& own = json["patches"][0];
  // On its own template it is itself.
  REQUIRE(in.ensemble("--from out.h5 -q -o again --patch first=out.json:1").status == 0);
  const auto again = nlohmann::json::parse(read_file(in.folder.file("again.json")))["fixed_patches"]["first"];
  CHECK(again["difference"].get<double>() == doctest::Approx(own["difference"].get<double>()));
  CHECK(again["area_A2"].get<double>() == doctest::Approx(own["area_A2"].get<double>()));
  CHECK(again["placement"]["found_area_fraction"].get<double>() == doctest::Approx(1));
  CHECK(again["placement"]["patch"] == 1);
  CHECK(contains(
      read_file(in.folder.file("again.json")),
      "patch first was found significant in frames that are measured here again: its difference is too large"));
  // On a frame's own surface, by compare; a trajectory has the same numbers, and a matrix.
  const std::string patch = " --patch first=out.json:1 --grid-spacing 1.5 --potential coulomb -q";
  const Outcome pair = in.run("compare w1.pqr m1.pqr" + patch + " -o pair");
  REQUIRE_MESSAGE(pair.status == 0, pair.err);
  const auto first = nlohmann::json::parse(read_file(in.folder.file("pair.json")))["fixed_patches"]["first"];
  CHECK(first["mean_signed_difference"].get<double>() < 0);
  CHECK(first["placement"]["found_area_fraction"].get<double>() > 0.8);
  CHECK(first["area_A2"]["source"].get<double>() == doctest::Approx(own["area_A2"].get<double>()).epsilon(0.25));
  const Outcome frames = in.run("trajectory w1.pqr m1.pqr --start source" + patch + " -o frames.csv");
  REQUIRE_MESSAGE(frames.status == 0, frames.err);
  const std::string rows = read_file(in.folder.file("frames.csv"));
  CHECK(contains(rows, "# patch_sha256: " + first["placement"]["sha256"].get<std::string>()));
  CHECK(contains(rows, first["mean_signed_difference"].dump()));
  const Outcome matrix = in.run("matrix w1.pqr m1.pqr" + patch + " -o all");
  REQUIRE_MESSAGE(matrix.status == 0, matrix.err);
  CHECK(contains(read_file(in.folder.file("all.json")), "first_mean_signed_difference"));
  CHECK(contains(
      in.run(
            "compare w1.pqr m1.pqr --patch first=out.json:1 --grid-spacing 1.5 --potential coulomb --overwrite -o pair")
          .out,
      "patch 1 of out.json; "));
  // What is none.
  const auto refused = [&](const std::string& text) {
    return in.run("compare w1.pqr m1.pqr -o u --patch " + text).err;
  };
  CHECK(contains(refused("first=out.json:99"), "patch first: out.json: there is no patch 99; it has "));
  CHECK(contains(refused("first=out.json:0"), "there is no patch 0"));
  CHECK(contains(refused("first=gone.json:1"), "gone.json"));
  CHECK(contains(refused("first=pair.json:1"), "pair.json: this is not the OUT.json of an ensemble of two groups"));
  std::filesystem::copy(in.folder.file("pair.vtp"), in.folder.file("out.vtp"),
                        std::filesystem::copy_options::overwrite_existing);
  CHECK(
      contains(refused("first=out.json:1"), "out.vtp: it has no array 'patch', so it is not of an ensemble's result"));
  std::filesystem::remove(in.folder.file("out.vtp"));
  CHECK(contains(refused("first=out.json:1"), "out.vtp"));
}

TEST_CASE(
    "given maps are each frame's potential: constants differ by what they differ, and what lacks a map is named") {
  const Runs in;
  std::filesystem::create_directory(in.folder.file("maps"));
  // Replicate r's frame f of the wild type has the potential 0.01 r + 0.1 f everywhere, the mutant's 2 more.
  for (int r = 1; r <= 4; ++r) {
    for (int f = 0; f < kFrames; ++f) {
      const std::string end = std::to_string(r) + ".00" + std::to_string(f) + ".dx";
      in.folder.write("maps/w" + end, constant_dx(24, 2, 0.01 * r + 0.1 * f, "kT/e", 8.4));
      in.folder.write("maps/m" + end, constant_dx(24, 2, 2 + 0.02 * r + 0.1 * f, "kT/e", 8.4));
    }
  }
  const std::string coarse = "ensemble --grid-spacing 1.5 ", maps = " --maps 'wild=maps/{replicate}.%03d.dx'",
                    both = maps + " --maps 'mutant=maps/{replicate}.%03d.dx'";
  const Outcome out = in.run(coarse + in.groups + both + " -o out --patch end=//A/7-8");
  REQUIRE_MESSAGE(out.status == 0, out.err);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  CHECK(json["plan"]["potential"] == "maps");
  CHECK(json["potential_unit"] == "kT/e");
  const auto& end = json["fixed_patches"]["end"];
  CHECK(end["means"]["wild"].get<double>() == doctest::Approx(0.025 + 0.15).epsilon(1e-5));
  CHECK(end["difference"].get<double>() == doctest::Approx(2 + 0.025).epsilon(1e-5));
  CHECK(contains(out.out, "potential    maps"));
  // The same with a list, resumed, in parts.
  std::string list = "group,structure,maps\n";
  for (const char* group : {"w", "m"}) {
    for (int r = 1; r <= 4; ++r) {
      const std::string name = group + std::to_string(r);
      list += std::string(*group == 'w' ? "wild" : "mutant") + "," + name + ".pqr,maps/" + name + ".%03d.dx\n";
    }
  }
  in.folder.write("list.csv", list);
  REQUIRE(in.run(coarse + "--list list.csv -q -o listed --patch end=//A/7-8").status == 0);
  CHECK(nlohmann::json::parse(read_file(in.folder.file("listed.json")))["fixed_patches"] == json["fixed_patches"]);
  CHECK(in.run(coarse + in.groups + both + " -q -o out --resume").status == 0);
  for (const char* part : {"1/2", "2/2"})
    REQUIRE(in.run(coarse + in.groups + both + " -q -o part --shard " + part).status == 0);
  REQUIRE(run_espdiff("merge part.shard-1-of-2.h5 part.shard-2-of-2.h5 -q -o all", "cd " + in.folder.file("") + " && ")
              .status == 0);
  CHECK(read_file(in.folder.file("all.h5")) == read_file(in.folder.file("out.h5")));
  // Maps of frames that have no charges.
  in.folder.write("bare.pdb", models(1, false, false));
  CHECK(in.run(coarse + "--group wild bare.pdb --maps 'wild=maps/w1.%03d.dx' -q -o bare").status == 0);
  const auto refused = [&](const std::string& text) { return in.run(coarse + in.groups + text + " -o u").err; };
  CHECK(
      contains(refused(maps), "replicate m4 of mutant has no maps, and replicate w4 of wild has; give all of them by"));
  CHECK(contains(refused(" --maps wild=maps/w1.dx"),
                 "--maps: 'maps/w1.dx' does not have one place for the frame's number"));
  CHECK(contains(refused(" --maps 'wild=maps/%d.%d.dx'"), "does not have one place"));
  CHECK(contains(refused(" --maps 'wild=maps/w1.%03d.dx'"),
                 "replicate w1 of wild and replicate w2 of wild would have the same maps"));
  CHECK(contains(refused(" --maps 'wild=maps/{replicate}.%02d.dx'"),
                 "frame 0 of replicate w1 of wild has no map: there is no file 'maps/w1.00.dx'"));
  CHECK(contains(refused(" --maps 'other=maps/{replicate}.%03d.dx'"), "is not GROUP=PATTERN with one of the groups"));
  CHECK(contains(refused(both + " --potential pb"), "--maps gives the potentials, and --potential pb computes them"));
  CHECK(contains(refused(" --map-unit mV"), "--map-unit is of given maps; name them by --maps"));
  in.folder.write("maps/w1.002.dx", constant_dx(24, 2, 0.2, "", 8.4));
  CHECK(contains(in.run(coarse + in.groups + both + " -o u --overwrite").err, "maps/w1.002.dx: the map's unit is "));
  in.folder.write("maps/w1.002.dx", constant_dx(24, 2, 0.2, "kT/e", 8.4));
  in.folder.write("maps/w1.003.dx", constant_dx(23, 2, 0.3, "kT/e", 8.4));
  CHECK(contains(in.run(coarse + in.groups + both + " -q -o out --resume").err, "maps of wild, w1"));
}

TEST_CASE("a list names groups, replicates of several files, and charges") {
  const Runs in;
  in.folder.write("w.pdb", models(1, false, false));
  in.folder.write("list.csv",
                  "group,replicate,structure,charges\nwild,1,w.pdb,w1.pqr\nwild,1,w2.pqr,\nmutant,1,m1.pqr,\n");
  const Outcome out = in.ensemble("--list list.csv -o out --template 2");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(out.err.find("espdiff: warning: a group has one replicate") == 0);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")));
  CHECK(json["plan"]["replicates"].size() == 2);
  CHECK(json["plan"]["replicates"][0]["n_frames"] == 2 * kFrames);
  CHECK(json["plan"]["template"]["name"] == "wild, replicate 1, frame 2");
  CHECK(json["test"]["inference"] == "within runs");
}

namespace {

/// The coordinates of models() as a DCD file, in CHARMM's layout without cells.
std::string dcd(const std::string& pqr) {
  std::vector<std::array<std::vector<float>, 3>> frames;
  std::istringstream lines(pqr);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("MODEL", 0) == 0) frames.emplace_back();
    if (line.rfind("ATOM", 0) != 0) continue;
    std::istringstream words(line);
    std::string word;
    for (int i = 0; i < 6; ++i) words >> word;
    for (auto& axis : frames.back()) {
      words >> word;
      axis.push_back(std::stof(word));
    }
  }
  return made_dcd(frames);
}

}  // namespace

TEST_CASE("trajectories with the atoms of a structure: the answer of the same frames as models") {
  if (espdiff::find_molfile_folder().empty()) {
    MESSAGE("SKIPPED: VMD's molfile plugins were not found; set $VMDDIR");
    return;
  }
  const Runs in;
  std::string groups, list = "group,replicate,topology,structure\n";
  for (const bool mutant : {false, true}) {
    groups += std::string(" --group ") + (mutant ? "mutant m1.pqr" : "wild w1.pqr");
    for (int r = 1; r <= 4; ++r) {
      const std::string name = (mutant ? "m" : "w") + std::to_string(r);
      in.folder.write(name + ".dcd", dcd(models(mutant ? r + 4 : r, mutant, true)));
      groups += " " + name + ".dcd";
      list += (mutant ? "mutant," : "wild,") + name + (mutant ? ",m1.pqr," : ",w1.pqr,") + name + ".dcd\n";
    }
  }
  in.folder.write("runs.csv", list);
  REQUIRE(in.ensemble(in.groups + " -q -o models --template 3").status == 0);
  const Outcome out = in.ensemble(groups + " -q -o frames --template 3");
  INFO(out.err);
  REQUIRE(out.status == 0);
  const auto answer = [&](const std::string& name) {
    return nlohmann::json::parse(read_file(in.folder.file(name + ".json")));
  };
  const auto json = answer("frames"), expected = answer("models");
  REQUIRE(json["patches"].size() == expected["patches"].size());
  // The trajectory's coordinates are of single precision.
  for (const char* key : {"area_A2", "difference", "low", "high"})
    CHECK(json["patches"][0][key].get<double>() ==
          doctest::Approx(expected["patches"][0][key].get<double>()).epsilon(1e-4));
  CHECK(json["plan"]["replicates"][0]["topology"] == "w1.pqr");
  REQUIRE(in.ensemble("--list runs.csv -q -o list --template 3").status == 0);
  CHECK(read_file(in.folder.file("list.h5")) == read_file(in.folder.file("frames.h5")));
  // Another topology is another ensemble.
  in.folder.write("w1.pqr", models(9, false, true));
  CHECK(in.ensemble(groups + " -q -o frames --template 3 --resume").err ==
        "espdiff: frames.h5 is of another run: the topology of replicate w1 of wild has changed; --overwrite begins "
        "anew\n");
  CHECK(in.ensemble("--group wild w1.dcd -o bad").err ==
        "espdiff: w1.dcd: a trajectory or topology has no structure of its own; name the structure or topology of its "
        "atoms first in the group, then the trajectories\n");
  in.folder.write("short.pqr", "ATOM 1 CA ALA A 1 0 0 0 0.2 2.2\n");
  CHECK(contains(in.ensemble("--group wild short.pqr w1.dcd -o bad").err, "w1.dcd"));
}

TEST_CASE("a DCD that was cut, and a frame that cannot be, in ensemble and trajectory") {
  if (espdiff::find_molfile_folder().empty()) {
    MESSAGE("SKIPPED: VMD's molfile plugins were not found; set $VMDDIR");
    return;
  }
  const Runs in;
  // Half of the last frame's 3 * (4 * 8 + 8) bytes is lost.
  const std::string whole = dcd(models(1, false, true)), lost = whole.substr(0, whole.size() - 60);
  const auto trajectory = [&](const std::string& more) {
    return in.run("trajectory w1.pqr w.dcd --potential none --grid-spacing 1.5 -q --overwrite -o t.csv " + more);
  };
  const std::string group = "--group wild w1.pqr w.dcd m.dcd -q --overwrite -o e ";
  in.folder.write("m.dcd", whole);
  in.folder.write("w.dcd", lost);
  const std::string cut =
      "w.dcd is cut off in frame 3 (60 of 120 bytes), and its head promises 4 frames; to take the whole frames, name "
      "the last one by its number, as in 0:2";
  CHECK_MESSAGE(contains(trajectory("").err, "--frames 'all': " + cut), trajectory("").err);
  CHECK(contains(in.ensemble(group).err, "--frames 'all': " + cut));
  CHECK(trajectory("--frames 0:2").status == 0);
  CHECK(in.ensemble(group + "--frames 0:2").status == 0);
  // The third frame's first x is not a number.
  std::string broken = whole;
  broken.replace(broken.size() - 2 * (whole.size() - 196) / 4 + 4, 4, std::string("\0\0\xc0\x7f", 4));
  in.folder.write("w.dcd", broken);
  CHECK(contains(trajectory("").err, "frame 2: w.dcd: frame 2: atom 0 is at (nan, "));
  const Outcome skipped = trajectory("--on-error skip");
  CHECK_MESSAGE(skipped.status == 0, skipped.err);
  CHECK(contains(read_file(in.folder.file("t.csv")), "\n2,file w1.pqr,"));
  CHECK(in.ensemble(group).status == 2);
  const Outcome ensemble = in.ensemble(group + "--on-error skip");
  CHECK_MESSAGE(ensemble.status == 0, ensemble.err);
}

TEST_CASE(
    "no output of an ensemble, of its shards' merge or of a matrix through a template is an input, through links too") {
  const Runs in;
  std::string activities = "replicate,value\n";
  for (const char group : {'w', 'm'}) {
    for (int r = 1; r <= 4; ++r) activities += group + std::to_string(r) + "," + std::to_string(r * r) + "\n";
  }
  in.folder.write("activities.csv", activities);
  const std::string end = " --grid-spacing 1.5 --device cpu --threads 1 -q ";
  check_linked_outputs(in.folder,
                       "ensemble " + in.groups +
                           " --potential coulomb --template w1.pqr --states "
                           "--check-template --regress activities.csv:value --charges mutant=m2.pqr -o out" +
                           end,
                       {"w1.pqr", "m4.pqr", "activities.csv", "m2.pqr"}, "--overwrite");
  check_linked_outputs(in.folder, "matrix w1.pqr m1.pqr --potential coulomb --template m2.pqr -o out" + end,
                       {"w1.pqr", "m1.pqr", "m2.pqr"}, "--overwrite");
  const std::string small = "--group wild w1.pqr w2.pqr ";
  for (const char* shard : {"1/2", "2/2"}) REQUIRE(in.ensemble(small + "-q -o part --shard " + shard).status == 0);
  check_linked_outputs(in.folder, "merge part.shard-1-of-2.h5 part.shard-2-of-2.h5 -q -o all",
                       {"part.shard-1-of-2.h5", "part.shard-2-of-2.h5"}, "--overwrite");
  // Statistics of a file: the file itself, and what is read besides.
  const Outcome merged = in.merge("part.shard-1-of-2.h5 part.shard-2-of-2.h5 -q -o all");
  REQUIRE_MESSAGE(merged.status == 0, merged.err);
  check_linked_outputs(in.folder, "ensemble --from all.h5 --states -q -o again --device cpu", {"all.h5"});
}

TEST_CASE("maps in vacuum of one group against maps in water of the other are refused before the work") {
  const ScratchFolder folder;
  // Enough charges for a map to be checked.
  std::string row;
  for (int i = 0; i < 24; ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "ATOM %d CA ALA A %d %.3f %.3f %.3f %.1f 2.2\n", i + 1, i + 1, 2.4 * i,
                  3 * std::sin(1.7 * i), 3 * std::cos(0.9 * i), i % 3 == 0 ? 1.0 : -0.4);
    row += line;
  }
  folder.write("row.pqr", row);
  for (const char* name : {"a1", "a2", "b1", "b2"})
    folder.write(std::string(name) + ".pqr",
                 "REMARK " + std::string(name) + "\nMODEL 1\n" + row + "ENDMDL\nMODEL 2\n" + row + "ENDMDL\n");
  const auto run = [&](const std::string& arguments) {
    return run_espdiff(arguments + " --device cpu --threads 1", "cd " + folder.file("") + " && ");
  };
  for (const char* map :
       {"vacuum.dx --method coulomb --grid 2", "vacuum2.dx --method coulomb --grid 2 --dielectric 1.1",
        "water.dx --method pb --pb-spacing 1.5", "water2.dx --method pb --pb-spacing 1.4"})
    REQUIRE(run(std::string("potential row.pqr -o ") + map).status == 0);
  const auto give = [&](const std::string& map, const std::string& replicate) {
    folder.write(replicate + ".0.dx", read_file(folder.file(map + ".dx")));
    folder.write(replicate + ".1.dx", read_file(folder.file(map + "2.dx")));
  };
  for (const char* replicate : {"a1", "a2"}) give("vacuum", replicate);
  for (const char* replicate : {"b1", "b2"}) give("water", replicate);
  const std::string both =
      "ensemble --grid-spacing 1.5 --group A a1.pqr a2.pqr --group B b1.pqr b2.pqr -q -o out "
      "--maps 'A={replicate}.%d.dx' --maps 'B={replicate}.%d.dx'";
  const Outcome out = run(both);
  CHECK(out.status == 2);
  CHECK(contains(out.err,
                 "\nespdiff: B, replicate b1, frame 0: its potential is a given map as in salt water, and that of A, "
                 "replicate a1, frame 0 a given map in vacuum; one in vacuum is tens of times one in salt water: give "
                 "maps of one kind, or take them as they are by --trust-maps\n"));
  CHECK(!std::filesystem::exists(folder.file("out.h5")));
  const Outcome trusted = run(both + " --trust-maps");
  CHECK_MESSAGE(trusted.status == 0, trusted.err);
  // One replicate among others is found when its turn comes.
  for (const char* replicate : {"a1", "a2"}) give("water", replicate);
  const Outcome water = run(both + " --overwrite");
  REQUIRE_MESSAGE(water.status == 0, water.err);
  give("vacuum", "b2");
  CHECK(contains(run(both + " --overwrite").err, "B, replicate b2, frame 0: its potential is a given map in vacuum"));
}

TEST_CASE("maps that a list or a pattern names are not replaced") {
  const Runs in;
  const std::string map = constant_dx(9, 6.0, 1.0, "kT/e", 8.0);
  std::string list = "group,structure,maps\n";
  for (int r = 1; r <= 4; ++r) list += "wild,w" + std::to_string(r) + ".pqr,m" + std::to_string(r) + "%d.vtp\n";
  for (int r = 1; r <= 4; ++r) {
    for (int f = 0; f < kFrames; ++f) in.folder.write("m" + std::to_string(r) + std::to_string(f) + ".vtp", map);
  }
  in.folder.write("list.csv", list);
  for (const char* how : {"--list list.csv", "--group wild w1.pqr w2.pqr --maps 'wild=m{replicate}%d.vtp'"}) {
    if (how[2] == 'g') {
      for (const char* name : {"mw10", "mw11", "mw12", "mw13", "mw20", "mw21", "mw22", "mw23"})
        in.folder.write(std::string(name) + ".vtp", map);
    }
    const std::string output = how[2] == 'g' ? "mw21" : "m20";
    const std::size_t n_before = in.folder.n_files();
    CHECK(in.run(std::string("ensemble ") + how + " -q -o " + output).err ==
          "espdiff: an output would replace an input: '" + output + ".vtp'; choose another name for the output\n");
    CHECK(read_file(in.folder.file(output + ".vtp")) == map);
    CHECK(in.folder.n_files() == n_before);
  }
}

TEST_CASE("a write that fails once, anywhere, leaves no file, or the right one; a merge leaves what was there") {
  if (std::system("strace -V >/dev/null 2>&1") != 0) {
    MESSAGE("SKIPPED: strace, which lets a write fail, is not installed");
    return;
  }
  const Runs in;
  const std::string group = "--group wild w1.pqr w2.pqr -q -o ";
  REQUIRE(in.ensemble(group + "whole").status == 0);
  for (const char* shard : {"1/2", "2/2"}) REQUIRE(in.ensemble(group + "part --shard " + shard).status == 0);
  const std::string whole = read_file(in.folder.file("whole.h5"));
  const Outcome merged = in.merge("part.shard-1-of-2.h5 part.shard-2-of-2.h5 -q -o merged");
  REQUIRE_MESSAGE(merged.status == 0, merged.err);
  CHECK(read_file(in.folder.file("merged.h5")) == whole);
  int n_failed = 0;
  for (int n = 1; n <= 400; n = n < 24 ? n + 1 : n * 3 / 2) {
    CAPTURE(n);
    const std::string fault =
        "strace -f -qq -o /dev/null -e inject=pwrite64:error=ENOSPC:when=" + std::to_string(n) + " ";
    const Outcome outcome = in.merge("part.shard-1-of-2.h5 part.shard-2-of-2.h5 -q --overwrite -o merged", fault);
    n_failed += outcome.status != 0 ? 1 : 0;
    CHECK(read_file(in.folder.file("merged.h5")) == whole);
    CHECK(n_lines(outcome.err) == (outcome.status != 0 ? 1 : 0));
    CHECK(in.folder.n_files() == 8 + 1 + 3 + 1 + 2);  // structures; whole's, merged and the parts
    if (outcome.status == 0) break;
  }
  CHECK(n_failed > 20);
}

TEST_CASE("a value of each replicate is regressed on the surface and predicted from the others") {
  const Runs in;
  // The charge of the last atom is the value.
  std::string group = "--group variant", table = "replicate,charge,note\n";
  const std::vector<double> charges = {-1, -0.6, -0.1, 0.4, 0.8, 1.2};
  for (std::size_t r = 0; r < charges.size(); ++r) {
    std::string text = models(static_cast<int>(r) + 1, true, true);
    char charge[16];
    std::snprintf(charge, sizeof charge, "%.4f", charges[r]);
    for (std::size_t at = 0; (at = text.find("-1.0000 2.2", at)) != std::string::npos; ++at)
      text.replace(at, 7, charge);
    const std::string name = "v" + std::to_string(r + 1);
    in.folder.write(name + ".pqr", text);
    group += " " + name + ".pqr";
    table += name + "," + charge + ",x\n";
  }
  in.folder.write("charges.csv", table);
  const Outcome out = in.ensemble(group + " -o out --template 0 --regress charges.csv:charge");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(contains(out.out, "regression on charge of 6 replicates, all 720 orders"));
  const auto json = nlohmann::json::parse(read_file(in.folder.file("out.json")))["regression"];
  CHECK(json["q2"].get<double>() > 0.95);
  CHECK(json["q2_p"].get<double>() < 0.01);
  REQUIRE(!json["patches"].empty());
  CHECK(json["patches"][0]["correlation"].get<double>() > 0.95);
  CHECK(json["patches"][0]["slope"].get<double>() > 0);
  for (std::size_t r = 0; r < charges.size(); ++r)
    CHECK(json["replicates"][r]["predicted"].get<double>() == doctest::Approx(charges[r]).scale(1).epsilon(0.2));
  CHECK(read_file(in.folder.file("out.regression.csv")).rfind("group,replicate,charge,predicted\nvariant,v1,-1,", 0) ==
        0);
  // From the file, with the same bytes.
  REQUIRE(in.run("ensemble --from out.h5 -q -o again --regress charges.csv:charge").status == 0);
  CHECK(read_file(in.folder.file("again.regression.csv")) == read_file(in.folder.file("out.regression.csv")));
  const auto refused = [&](const std::string& regress, const std::string& more) {
    return in.run("ensemble --from out.h5 -q -o bad --regress " + regress + more).err;
  };
  CHECK(refused("charges.csv", "") ==
        "espdiff: --regress charges.csv is not FILE.csv:COLUMN, such as activities.csv:log_kcat\n");
  CHECK(contains(refused("charges.csv:size", ""), "size"));
  CHECK(contains(refused("charges.csv:note", ""), "charges.csv"));
  in.folder.write("other.csv", "replicate,charge\nv1,1\nw9,2\n");
  CHECK(refused("other.csv:charge", "") ==
        "espdiff: other.csv:3: 'w9' is no replicate of this ensemble; there are variant, v1 and 5 others\n");
  in.folder.write("few.csv", "replicate,charge\nv1,1\nv2,2\nv3,3\nv4,\n");
  CHECK(refused("few.csv:charge", "") ==
        "espdiff: a regression needs the values of 4 replicates or more, and there are 3\n");
  in.folder.write("twice.csv", "replicate,charge\nv1,1\nv1,2\n");
  CHECK(refused("twice.csv:charge", "") == "espdiff: twice.csv:3: 'v1' stands here a second time\n");
}

TEST_CASE("outside of the surface the differences are smaller") {
  const Runs in;
  REQUIRE(in.ensemble(in.groups + " -q -o at --template 3").status == 0);
  REQUIRE(in.ensemble(in.groups + " -q -o outside --template 3 --offset 3").status == 0);
  const auto difference = [&](const std::string& name) {
    const auto json = nlohmann::json::parse(read_file(in.folder.file(name + ".json")));
    return json["test"]["mean_abs_difference"].get<double>();
  };
  // The charge of -1.2 e is 2 A below the surface, so its potential falls from 1 / 2 to 1 / 5 right above it.
  MESSAGE("mean absolute difference at the surface ", difference("at"), ", 3 A outside ", difference("outside"));
  CHECK(difference("outside") < 0.9 * difference("at"));
  CHECK(difference("outside") > 0.2 * difference("at"));
  CHECK(contains(in.ensemble(in.groups + " -o bad --offset 0,3").err, "give one"));
}

TEST_CASE("given maps are refused by their name, pme without water takes a box") {
  const Runs in;
  CHECK(contains(in.ensemble(in.groups + " -o bad --potential maps").err, "--potential"));
  CHECK(in.run("ensemble --grid-spacing 1.5 --potential pme --group wild w1.pqr w2.pqr -q -o pme").status == 0);
}

TEST_CASE("models of ubiquitin: through the template, a pair differs as compare says") {
  const auto models = real_input("series19_ubq_2k39");
  if (!models) return;
  const Runs in;
  std::string list = "group,replicate,structure\n";
  for (int i = 0; i < 4; ++i)
    list += "ubiquitin," + std::to_string(i / 2 + 1) + "," + *models + "/m0" + std::to_string(i) + ".pqr\n";
  in.folder.write("ubiquitin.csv", list);
  const Outcome out = in.ensemble("--list ubiquitin.csv -o ubq --states --template 0");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(contains(out.out, "principal components of 4 frames"));
  const std::string states = read_file(in.folder.file("ubq.states.csv"));
  std::istringstream rows(states);
  double through_template = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.rfind("ubiquitin,1,1,ubiquitin,2,0,", 0) == 0)
      through_template = std::stod(row.substr(std::string("ubiquitin,1,1,ubiquitin,2,0,").size()));
  }
  // Neither of the two is the template.
  REQUIRE(in.run("compare " + *models + "/m01.pqr " + *models +
                 "/m02.pqr --grid-spacing 1.5 --potential coulomb -q --exit-zero -o pair")
              .status == 0);
  const auto pair = nlohmann::json::parse(read_file(in.folder.file("pair.json")));
  CHECK(through_template == doctest::Approx(pair.at("mean_abs_difference").get<double>()).epsilon(0.15));
}

TEST_CASE("models of ubiquitin: a matrix through a template is near the exact one, and says how near") {
  const auto models = real_input("series19_ubq_2k39");
  if (!models) return;
  const Runs in;
  std::string files;
  for (const char* name : {"m01", "m02", "m04"}) files += " " + *models + "/" + name + ".pqr";
  const std::string common = "matrix" + files + " --grid-spacing 1.5 --potential coulomb --template ";
  const Outcome out = in.run(common + "m02 --exact-sample 6 -o ubq");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(contains(out.out, "through one template: m02, "));
  CHECK(contains(out.out, "6 pairs by themselves  "));  // all there are: none was chosen
  CHECK(contains(out.out, "3 states mapped in "));
  const auto json = nlohmann::json::parse(read_file(in.folder.file("ubq.json")));
  const auto& agreement = json["template"]["exact"]["agreement"]["mean_abs_difference"];
  CHECK(agreement["n"] == 6);
  // The pairs by themselves count trusted area, the template all that has a counterpart.
  CHECK(agreement["largest_difference"].get<double>() < 0.2 * agreement["exact_mean"].get<double>());
  CHECK(json["template"]["states"].size() == 3);
  CHECK(json["template"]["states"][1]["rmsd_A"].get<double>() == doctest::Approx(0).scale(1));
  CHECK(json["template"]["options"]["max_step_A"] == 0.7);
  CHECK(json["options"]["max_step_A"] == 0.35);
  // The heat map reads it as any matrix; the ensemble's components read its file.
  CHECK(in.run("ensemble --from ubq.h5 --states -q -o pca").status == 0);
  CHECK(n_lines(read_file(in.folder.file("pca.components.csv"))) == 4);
  CHECK(contains(in.run(common + "m07 -o bad").err, "--template m07 is neither medoid, nor the label of a variant"));
}

TEST_CASE("a matrix through a template: two processes merge to the bytes of one, and bad parts are named") {
  const Runs in;
  const std::string common =
      "matrix w1.pqr --grid-spacing 1.5 --potential coulomb --template medoid --exact-sample 2 -q ";
  REQUIRE(in.run(common + "-o whole").status == 0);
  for (const char* shard : {"1/2", "2/2"}) REQUIRE(in.run(common + "-o part --shard " + shard).status == 0);
  const auto merge = [&](const std::string& parts) {
    return run_espdiff("merge " + parts + " -o merged", "cd " + in.folder.file("") + " && ");
  };
  const std::string files = "part.shard-1-of-2.h5 part.shard-2-of-2.h5", first = " part.shard-1-of-2.state";
  CHECK(contains(merge(files + first).err, "is missing; resume the shard that lacks it, or name its state file too"));
  CHECK(contains(merge("part.shard-1-of-2.h5" + first + " part.shard-2-of-2.state").err,
                 "none of the files has frame 2 (w1:3)"));
  CHECK_FALSE(std::filesystem::exists(in.folder.file("merged.h5")));
  const Outcome out = merge(files + first + " part.shard-2-of-2.state");
  INFO(out.err);
  REQUIRE(out.status == 0);
  CHECK(contains(out.out, "through one template: medoid: w1:"));
  for (const char* ending : {".csv", ".json", ".h5"})
    CHECK(read_file(in.folder.file(std::string("merged") + ending)) ==
          read_file(in.folder.file(std::string("whole") + ending)));
}

TEST_CASE("a matrix through a template has fields: near the exact pairs, and the same bytes from two processes") {
  const Runs in;
  const std::string common =
      "matrix w1.pqr --grid-spacing 1.5 --potential coulomb --field charge --field curvature --template medoid "
      "--exact-sample 6 -q ";
  const Outcome whole = in.run(common + "-o whole");
  REQUIRE_MESSAGE(whole.status == 0, whole.err);
  const auto json = nlohmann::json::parse(read_file(in.folder.file("whole.json")));
  CHECK(json["fields"].size() == 2);
  for (const char* name : {"charge_mean_abs_difference", "charge_rms_difference", "charge_hodgkin_index",
                           "curvature_correlation", "curvature_rms_difference"}) {
    const auto& agreement = json["template"]["exact"]["agreement"][name];
    INFO(name);
    REQUIRE(agreement["n"] == 6);
    CHECK(std::fabs(agreement["exact_mean"].get<double>() - agreement["template_mean"].get<double>()) <=
          0.3 * std::fabs(agreement["exact_mean"].get<double>()));
  }
  for (const char* shard : {"1/2", "2/2"}) REQUIRE(in.run(common + "-o part --shard " + shard).status == 0);
  const auto merge = [&](const std::string& parts) {
    return run_espdiff("merge " + parts + " -o merged", "cd " + in.folder.file("") + " && ");
  };
  CHECK(contains(merge("part.shard-?-of-2.h5 part.*.state").err, "the parts of the field charge are missing"));
  CHECK(contains(merge("part.charge.shard-?-of-2.h5").err, "the parts of its matrix are missing"));
  const Outcome merged = merge("part*.h5 part.*.state");
  REQUIRE_MESSAGE(merged.status == 0, merged.err);
  for (const char* ending : {".csv", ".json", ".h5", ".charge.h5", ".curvature.h5"})
    CHECK(read_file(in.folder.file(std::string("merged") + ending)) ==
          read_file(in.folder.file(std::string("whole") + ending)));
}

TEST_CASE("what cannot be an ensemble is refused in one line") {
  const Runs in;
  in.folder.write("one.pqr", models(1, false, true).substr(0, models(1, false, true).find("MODEL     2")));
  in.folder.write("bare.pdb", models(1, false, false));
  in.folder.write("bare2.pdb", models(2, false, false));
  in.folder.write("copy.pqr", models(1, false, true));
  in.folder.write("other.pqr", "ATOM 1 ZN ZN B 1 0 0 0 2 1\nATOM 2 ZN ZN B 2 3 0 0 2 1\nATOM 3 ZN ZN B 3 0 3 0 2 1\n");
  const auto refused = [&](const std::string& arguments) {
    const Outcome out = in.ensemble(arguments + " -o bad");
    CHECK(out.status == 2);
    CHECK(n_lines(out.err) <= 2);  // perhaps a warning about the design before it
    for (const auto& entry : std::filesystem::directory_iterator(in.folder.file("")))
      CHECK(entry.path().filename().string().rfind("bad", 0) != 0);
    return first_line(out.err.rfind("espdiff: warning", 0) == 0 ? out.err.substr(out.err.find('\n') + 1) : out.err);
  };
  CHECK(refused("") == "espdiff: no group was given; name one or two by --group, or a --list of them");
  CHECK(refused("--group wild") ==
        "espdiff: --group takes a name and one file or more, each a replicate; 'wild' stands alone");
  CHECK(refused("--group w1.pqr w2.pqr") ==
        "espdiff: --group: 'w1.pqr' is a file; the first word is the group's name, such as wild");
  CHECK(refused("--group wild w1.pqr one.pqr --group mutant m1.pqr m2.pqr") ==
        "espdiff: replicate one of wild has 1 frame; a replicate needs two or more");
  CHECK(
      refused("--group wild w1.pqr copy.pqr --group mutant m1.pqr m2.pqr") ==
      "espdiff: copy.pqr of replicate copy of wild has the same content as replicate w1 of wild (w1.pqr); a replicate "
      "counts once");
  CHECK(refused("--group a w1.pqr --group b w2.pqr --group c w3.pqr") ==
        "espdiff: there are 3 groups (a, b, c); two are compared at a time, and one is described alone");
  CHECK(refused(in.groups + " --template 99") ==
        "espdiff: --template 99: there are 32 frames in all groups, numbered from 0");
  CHECK(refused(in.groups + " --template medoid:apo") ==
        "espdiff: --template medoid:apo: there is no group of this name");
  CHECK(refused("--group wild bare.pdb bare2.pdb --charges wild=other.pqr") ==
        "espdiff: wild, replicate bare, frame 0: bare.pdb, model 1 has no charges and radii, and cannot take those of "
        "other.pqr: it lacks ZN of ZN B 1, CA of ALA A 1 is not in other.pqr (8 and 3 atoms); give frames and source "
        "of the same atoms, or frames as PQR");
  CHECK(refused(in.groups + " --charges wild.pqr") ==
        "espdiff: --charges wild.pqr is not GROUP=FILE with one of the groups, such as wild=wild.pqr");
  CHECK(refused(in.groups + " --template other.pqr").find("wild, replicate w1, frame 0: ") != std::string::npos);
  CHECK(refused(in.groups + " --method deform").find("a template is mapped by the morph") != std::string::npos);
  CHECK(refused("--group wild bare.pdb w1.pqr --group mutant m1.pqr m2.pqr").find("bare.pdb") != std::string::npos);
}

TEST_CASE("a file of other settings, of another template, or in the way is refused") {
  const Runs in;
  REQUIRE(in.ensemble(in.groups + " -q -o out --template 0").status == 0);
  const std::string bytes = read_file(in.folder.file("out.h5"));
  CHECK(in.ensemble(in.groups + " -q -o out --template 0").err ==
        "espdiff: the ensemble file out.h5 exists; --resume continues it, --overwrite begins anew\n");
  // One remedy for a file that cannot be continued, whether or not --resume is given.
  const std::string remedy = "; begin anew with another output, or with --overwrite\n";
  for (const auto& [n_bytes, what] : {std::pair{5, "not the OUT.h5 of an ensemble: no HDF5 file"},
                                      std::pair{1000, "the file is cut off, or its structure is damaged"}}) {
    for (const char* resume : {"", " --resume"}) {
      const std::string part = bytes.substr(0, static_cast<std::size_t>(n_bytes));
      in.folder.write("cut.h5", part);
      CHECK(in.ensemble(in.groups + " -q -o cut --template 0" + resume).err == "espdiff: cut.h5: " + (what + remedy));
      CHECK(read_file(in.folder.file("cut.h5")) == part);
    }
  }
  CHECK(in.ensemble(in.groups + " -q -o out --template 1 --resume").err ==
        "espdiff: out.h5 is of another run: the template is wild, replicate w1, frame 0 there and wild, replicate w1, "
        "frame 1 here; --overwrite begins anew\n");
  CHECK(in.ensemble(in.groups + " -q -o out --template 0 --offset 2 --resume").err ==
        "espdiff: out.h5 is of another run: the setting offset is 0 there and 2 here; --overwrite begins anew\n");
  CHECK(read_file(in.folder.file("out.h5")) == bytes);
}
