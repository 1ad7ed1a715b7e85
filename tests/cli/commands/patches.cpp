// patches.cpp: --patch in `espdiff compare`, `trajectory` and `matrix`: columns, numbers against an own sum over the
// written surface, and what cannot be a patch.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/bent_row.h"
#include "cli/run_espdiff.h"
#include "io/files/read_csv.h"
#include "io/vtk/read_vtp.h"

using namespace espdiff_test;  // NOLINT: a test
using Json = nlohmann::json;

namespace {

struct PatchFiles {
  ScratchFolder folder;
  std::string a = folder.write("a.pqr", bent_row(0)), b = folder.write("b.pqr", bent_row(0.3)),
              c = folder.write("c.pqr", bent_row(0.6)),
              frames = folder.write("frames.pqr",
                                    "MODEL 1\n" + bent_row(0.3) + "ENDMDL\nMODEL 2\n" + bent_row(0.6) + "ENDMDL\n");
  std::string out(const std::string& name) const { return folder.file(name); }
};

const std::string kPatches = " --patch site=//A/2-4 --patch far-end=//A/8-9";

Json compared(const PatchFiles& files, const std::string& arguments, const std::string& name = "one") {
  const Outcome outcome =
      run_espdiff("compare " + arguments + kUsual + " --exit-zero --overwrite -o " + files.out(name));
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return Json::parse(read_file(files.out(name + ".json")));
}

std::string refused_patch(const std::string& arguments) {
  const Outcome outcome = run_espdiff(arguments + kUsual);
  CHECK(outcome.status == 2);
  CHECK(n_lines(outcome.err) <= 2);  // of wrong options the second names --help
  return outcome.err;
}

/// Mean, mean magnitude and area of the difference over residues, from OUT.vtp alone: a third of each triangle's area
/// at each of its corners, triangles with two or more corners of the residues.
struct Sums {
  double area = 0, mean = 0, magnitude = 0;
};

Sums sums_of(const std::string& path, int first, int last) {
  const espdiff::VtpContent vtp = espdiff::read_vtp(path);
  const auto& difference = espdiff::find_array(vtp.point_arrays, "potential_difference")->values;
  const auto& number = espdiff::find_array(vtp.point_arrays, "residue_number")->values;
  const auto& why = espdiff::find_array(vtp.cell_arrays, "why")->values;
  Sums sums;
  double weight = 0;
  for (std::size_t t = 0; t < vtp.triangles.size(); ++t) {
    const auto& v = vtp.triangles[t];
    const auto n = std::count_if(v.begin(), v.end(), [&](auto c) { return number[c] >= first && number[c] <= last; });
    if (n < 2 || why[t] != 0) continue;
    const auto &p = vtp.positions[v[0]], &q = vtp.positions[v[1]], &r = vtp.positions[v[2]];
    const double area = 0.5 * norm(cross(q - p, r - p));
    sums.area += area;
    for (const auto c : v) {
      if (!std::isfinite(difference[c])) continue;
      sums.mean += area / 3 * difference[c];
      sums.magnitude += area / 3 * std::fabs(difference[c]);
      weight += area / 3;
    }
  }
  sums.mean /= weight;
  sums.magnitude /= weight;
  return sums;
}

}  // namespace

TEST_CASE("compare: a patch has the numbers of its surface, by a sum of its own over OUT.vtp") {
  const PatchFiles files;
  const Json result = compared(files, files.a + " " + files.c + kPatches);
  REQUIRE(result["fixed_patches"].size() == 2);
  for (const auto& [name, first, last] : {std::tuple("site", 2, 4), std::tuple("far-end", 8, 9)}) {
    const Json& patch = result["fixed_patches"][name];
    const Sums sums = sums_of(files.out("one.vtp"), first, last);
    CHECK(patch["mean_signed_difference"].get<double>() == doctest::Approx(sums.mean).epsilon(1e-4));
    CHECK(patch["mean_abs_difference"].get<double>() == doctest::Approx(sums.magnitude).epsilon(1e-4));
    CHECK(patch["area_A2"]["trusted"].get<double>() == doctest::Approx(sums.area).epsilon(1e-4));
    CHECK(patch["n_residues"] == last - first + 1);
    CHECK(patch["mean_abs_difference"].get<double>() > 0.001);
  }
  CHECK(result["region"].is_null());
  const espdiff::CsvTable residues = espdiff::read_csv(files.out("one.residues.csv"));
  CHECK(cell(residues, 2, "patch_site") == "1");
  CHECK(cell(residues, 2, "patch_far-end") == "0");
  CHECK(cell(residues, 8, "patch_far-end") == "1");
}

TEST_CASE("compare: a patch has the region's numbers of the same residues, beside a region") {
  const PatchFiles files;
  Json result = compared(files, files.a + " " + files.c + " --region //A/2-4" + kPatches);
  CHECK(result["region"] == result["fixed_patches"]["site"]);
  const Outcome printed = run_espdiff("compare " + files.a + " " + files.c + kPatches +
                                      " --full --device cpu --pb-spacing 1 -o " + files.out("p"));
  CHECK(contains(printed.out, "Patch site: 3 residues of the source"));
  CHECK(contains(printed.out, "Patch far-end: 2 residues of the source"));
}

TEST_CASE("trajectory: the columns of patches are compare's numbers, frame by frame, and resume to the same bytes") {
  const PatchFiles files;
  const std::string run =
      "trajectory " + files.a + " " + files.frames + kPatches + kUsual + " -o " + files.out("t.csv");
  REQUIRE(run_espdiff(run).status == 0);
  const espdiff::CsvTable table = espdiff::read_csv(files.out("t.csv"));
  for (int model = 1; model <= 2; ++model) {
    const Json one =
        compared(files, files.a + " " + files.frames + kPatches + " --target-model " + std::to_string(model));
    for (const char* name : {"site", "far-end"}) {
      const Json& patch = one["fixed_patches"][name];
      const auto there = [&](const std::string& column) {
        return std::stod(cell(table, static_cast<std::size_t>(model - 1), std::string(name) + "_" + column));
      };
      CHECK(there("mean_signed_difference") == patch["mean_signed_difference"].get<double>());
      CHECK(there("mean_displacement_A") == patch["mean_displacement_A"].get<double>());
      CHECK(there("area_mapped_A2") == patch["area_A2"]["mapped"].get<double>());
      CHECK(there("trustworthy") == (patch["certificate"]["trustworthy"].get<bool>() ? 1 : 0));
    }
  }
  const std::string whole = read_file(files.out("t.csv"));
  files.folder.write("t.csv", whole.substr(0, whole.size() - 20));
  REQUIRE(run_espdiff(run + " --resume").status == 0);
  CHECK(read_file(files.out("t.csv")) == whole);
  const std::string other = refused_patch("trajectory " + files.a + " " + files.frames +
                                          " --patch site=//A/2-5 --resume -o " + files.out("t.csv"));
  CHECK_MESSAGE(contains(other, "was made with settings"), other);
}

TEST_CASE("matrix: the metrics of patches are compare's numbers, in files, parts and clusters") {
  const PatchFiles files;
  const std::string run = "matrix " + files.a + " " + files.b + " " + files.c + kPatches + kUsual + " -o ",
                    by = " --cluster-by site_mean_abs_difference";
  const Outcome outcome = run_espdiff(run + files.out("m") + by);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const Json matrix = Json::parse(read_file(files.out("m.json"))),
             one = compared(files, files.a + " " + files.c + kPatches);
  const Json& metric = matrix["metrics"]["site_mean_abs_difference"];
  CHECK(metric["values"][0][2] == one["fixed_patches"]["site"]["mean_abs_difference"]);
  CHECK(metric["title"] == "Mean absolute difference, site");
  CHECK(matrix["far-end_trustworthy"][0][2] == one["fixed_patches"]["far-end"]["certificate"]["trustworthy"]);
  CHECK(matrix["clustering"]["metric"] == "site_mean_abs_difference");
  const espdiff::CsvTable table = espdiff::read_csv(files.out("m.csv"));
  CHECK(std::stod(cell(table, 1, "far-end_mean_signed_difference")) ==
        doctest::Approx(one["fixed_patches"]["far-end"]["mean_signed_difference"].get<double>()).epsilon(1e-5));
  for (const char* part : {"1/2", "2/2"})
    REQUIRE(run_espdiff(run + files.out("p") + by + " --shard " + part).status == 0);
  const Outcome merged =
      run_espdiff("merge " + files.out("p.shard-1-of-2.state") + " " + files.out("p.shard-2-of-2.state") +
                  " --cluster-by site_mean_abs_difference -q -o " + files.out("p"));
  REQUIRE_MESSAGE(merged.status == 0, merged.err);
  CHECK(read_file(files.out("p.json")) == read_file(files.out("m.json")));
  CHECK(contains(run_espdiff(run + files.out("x") + " --cluster-by site_slip_mean_A").err, "there is no metric"));
}

TEST_CASE("a patch that is buried says so; one without counterparts says so") {
  const PatchFiles files;
  // A small atom within a large one has no surface.
  const std::string inner = "ATOM     10  CB  GLY A  10       7.800   0.000   0.500  0.1000 0.5000\n";
  const std::string with = files.folder.write("with.pqr", bent_row(0) + inner);
  const Json result = compared(files, with + " " + with + " --patch core=//A/10 --patch rest=//A/1-9");
  const Json& core = result["fixed_patches"]["core"];
  CHECK(core["certificate"]["reasons"] == Json({"it has no surface: its residues are buried in the source"}));
  CHECK(core["certificate"]["trustworthy"] == false);
  CHECK(core["area_A2"]["source"] == 0);
  for (const char* name : {"mean_abs_difference", "mean_displacement_A"}) CHECK(core[name].is_null());
  CHECK(core["certificate"]["no_counterpart_area_fraction"]["source"].is_null());
  CHECK(result["fixed_patches"]["rest"]["certificate"]["trustworthy"] == true);
  // A ligand that the target lacks.
  const std::string ligand = "HETATM   10  C1  LIG B   1      10.000  30.000   0.000  0.1000 2.5000\n";
  const std::string far = files.folder.write("far.pqr", bent_row(0) + ligand);
  const Json lost = compared(files, far + " " + files.b + " --patch ligand=//B --cavities")["fixed_patches"]["ligand"];
  CHECK(lost["area_A2"]["source"].get<double>() > 10);
  CHECK(lost["certificate"]["reasons"] == Json({"none of its surface has a counterpart on the target"}));
  CHECK(lost["certificate"]["no_counterpart_area_fraction"]["source"] == 1);
  CHECK(lost["mean_abs_difference"].is_null());
}

TEST_CASE("what cannot be a patch is refused, before any file is written") {
  const PatchFiles files;
  const std::string pair = "compare " + files.a + " " + files.b + " -o " + files.out("u");
  const auto refused = [&](const std::string& patch) { return refused_patch(pair + " --patch " + patch); };
  CHECK(contains(refused("site"), "--patch: 'site' is not NAME=SELECTION, such as site=//A/8-12"));
  CHECK(contains(refused("site="), "--patch: 'site=' is not NAME=SELECTION"));
  CHECK(contains(refused("'=//A/8'"), "--patch: the name '' of '=//A/8' is not a letter followed by"));
  CHECK(contains(refused("'far end=//A/8'"), "--patch: the name 'far end' of 'far end=//A/8' is not a letter"));
  CHECK(contains(refused("'5a=//A/8'"), "--patch: the name '5a'"));
  CHECK(contains(refused("'caf\xc3\xa9=//A/8'"), "--patch: the name 'caf\xc3\xa9'"));
  CHECK(contains(refused("'a,b=//A/8'"), "--patch: the name 'a,b'"));
  CHECK(contains(refused(std::string(41, 'x') + "=//A/8"), "(at most 40 in all)"));
  CHECK(contains(refused("region=//A/8"), "--patch: the name 'region' is that of --region; take another one"));
  CHECK(contains(refused("site=//A/8 --patch site=//A/9"),
                 "--patch: the name site is given twice; name each patch once"));
  const std::string empty = refused("site=//Q");
  CHECK_MESSAGE(contains(empty, "patch site: " + files.a + ": --patch '//Q' selects no atom"), empty);
  CHECK(contains(empty, "chain A"));
  CHECK_FALSE(std::filesystem::exists(files.out("u.json")));
  const std::string in_matrix =
      refused_patch("matrix " + files.a + " " + files.b + " --patch site=//Q -o " + files.out("u"));
  CHECK_MESSAGE(contains(in_matrix, "patch site: " + files.a + ": --patch '//Q' selects no atom"), in_matrix);
}
