// ensemble_result.cpp: from a file of known values to patches, residues, noise and warnings.
#include "ensemble/result/ensemble_result.h"

#include <doctest/doctest.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>

#include <boost/math/distributions/non_central_t.hpp>
#include <nlohmann/json.hpp>

#include "ensemble/frames/replicate_request.h"
#include "ensemble/planted_file.h"
#include "ensemble/relabel.h"
#include "ensemble/result/ensemble_json.h"
#include "ensemble/result/ensemble_table.h"
#include "ensemble/result/write_ensemble.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

TEST_SUITE_BEGIN("ensemble result");

namespace {

bool is_planted(const Vec3d& p) { return p.x > 0 && p.y > 8; }

/// Planted vertices with a property, and their number.
template <typename Holds>
std::pair<double, double> share_of_planted(const EnsembleFile& file, Holds holds) {
  double n = 0, n_holding = 0;
  for (std::size_t v = 0; v < file.n_vertices(); ++v) {
    if (!is_planted(file.surface().positions[v])) continue;
    ++n;
    n_holding += holds(v) ? 1 : 0;
  }
  return {n_holding / n, n};
}

double three_deviations(double share, double n) { return 3 * std::sqrt(share * (1 - share) / n); }

}  // namespace

TEST_CASE("of a file of an earlier version all counts as trusted, and a warning says so") {
  const ScratchFolder folder;
  const std::string path = folder.file("old.h5");
  const EnsemblePlan plan = planted_plan(4, 4, 20);
  EnsembleFile::create(path, plan, planted_template(2));
  CHECK(EnsembleFile(path, false).has_trust());
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  CHECK(H5Ldelete(file, "/VTKHDF/PointData/trusted", H5P_DEFAULT) >= 0);
  std::uint64_t head[2] = {};  // the second is of the structure, and is not in the oldest files
  const hid_t checksums = H5Dopen2(file, "/espdiff/head_checksum", H5P_DEFAULT);
  CHECK(H5Dread(checksums, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, head) >= 0);
  H5Dclose(checksums);
  CHECK(H5Ldelete(file, "/espdiff/head_checksum", H5P_DEFAULT) >= 0);
  const hsize_t one = 1;
  const hid_t space = H5Screate_simple(1, &one, nullptr);
  const hid_t oldest =
      H5Dcreate2(file, "/espdiff/head_checksum", H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  CHECK(H5Dwrite(oldest, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, head) >= 0);
  H5Dclose(oldest);
  H5Sclose(space);
  H5Fclose(file);
  EnsembleFile old(path, true);
  CHECK_FALSE(old.has_trust());
  fill_planted(old, plan, -1, 5);
  const EnsembleResult result = analyse_ensemble(old, {});
  CHECK(result.tested_share() == 1);
  REQUIRE(result.warnings.size() >= 1);
  CHECK(std::count(
            result.warnings.begin(), result.warnings.end(),
            "an earlier version made the file, which does not say where its frames trust the mapping: all that has "
            "a counterpart counts as trusted") == 1);
}

TEST_CASE("the planted patch is found where it is, with its size, its residue and its sign") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(4, 4, 100), -1, 5);
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  REQUIRE(result.patches.size() == 1);
  const EnsemblePatch& patch = result.patches[0];
  double planted_area = 0;
  for (std::size_t v = 0; v < file.n_vertices(); ++v)
    planted_area += is_planted(file.surface().positions[v]) ? result.graph.area[v] : 0;
  CHECK(patch.patch.area < 1.2 * planted_area);
  CHECK(patch.residues.front().first == "ALA 1");
  CHECK(patch.residues.front().second > 0.8);
  CHECK(patch.smallest_p == doctest::Approx(2.0 / 70));
  CHECK(result.patch_tests.difference[0] == doctest::Approx(-1).epsilon(0.15));
  CHECK(result.patch_tests.low[0] < -0.9);
  CHECK(result.patch_tests.high[0] > -1.1);
  CHECK(result.residues[0].adjusted_p < 0.01);
  // One replicate against another differs by noise, and more where the effect is.
  CHECK(result.noise.across > result.noise.replicates[0]);
  for (const ReplicateSummary& r : result.replicates) {
    CHECK(r.inefficiency == doctest::Approx(3).epsilon(0.2));  // (1 + 0.5) / (1 - 0.5)
    CHECK(r.error_ratio == doctest::Approx(1).epsilon(0.25));
  }
  CHECK(result.warnings.empty());
  CHECK(result.not_equilibrium.empty());
}

TEST_CASE("fields of a run are tested together; one that does not change takes nothing away from the others") {
  const ScratchFolder folder;
  std::vector<std::unique_ptr<EnsembleFile>> files;
  std::vector<const EnsembleFile*> all;
  for (const char* name : {"a", "b", "still"}) {
    EnsemblePlan plan = planted_plan(4, 4, 20);
    plan.field = FieldDescription{{name, std::string("Field ") + name, "", true}, name, "", {}};
    plan.n_fields = 3;
    plan.potential = plan.field->quantity.label;
    plan.potential_unit = "";
    const std::string path = folder.file(name + std::string(".h5"));
    if (name == std::string("still")) {
      const TemplateSurface surface = planted_template(2);
      EnsembleFile::create(path, plan, surface);
      EnsembleFile file(path, true);
      for (std::size_t f = 0; f < plan.n_frames(); ++f)
        file.write(f, std::vector<float>(surface.positions.size(), 1.8F), {1, 0, 0, 0, 1, 1.8, true, ""});
    } else {
      plant_file(path, plan, name == std::string("a") ? -2 : 0, name[0]);
    }
    files.push_back(std::make_unique<EnsembleFile>(path, false));
    all.push_back(files.back().get());
  }
  const std::vector<FieldStatistics> together = analyse_fields(all, {});
  CHECK(together[2].why_not ==
        "values of replicate 1 of wild do not change from frame to frame; are its frames copies of one structure?");
  REQUIRE(together[0].result);
  REQUIRE(together[1].result);
  CHECK(together[0].result->n_together == 2);
  REQUIRE(!together[0].result->patches.empty());
  CHECK(together[0].result->patches[0].smallest_p == doctest::Approx(2.0 / 70));
  CHECK(together[1].result->patches.empty());
  const EnsembleResult alone = analyse_ensemble(*all[1], {});
  for (std::size_t v = 0; v < all[1]->n_vertices(); ++v) {
    if (std::isfinite(alone.test.p_tfce[v])) CHECK(together[1].result->test.p_tfce[v] >= alone.test.p_tfce[v]);
  }
  CHECK(alone.warnings.front() ==
        "family-wise p are over the surface of this field alone, one of 3; compute the statistics of all of them "
        "together");
  std::ostringstream table;
  print_ensemble(table, *all[0], *together[0].result);
  CHECK(
      table.str().find("field        Field a\nfamily       p is family-wise over the surfaces of 2 fields together") !=
      std::string::npos);
  CHECK(table.str().find("mean absolute difference over the tested surface\n") != std::string::npos);
  CHECK(parse_ensemble_plan(plan_text(all[0]->plan()), "a").field->quantity.label == "Field a");
}

TEST_CASE("as much of the planted patch is found as the noncentral t distribution says") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(4, 4, 100), -1, 5, 4);
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  const PlaceTests& t = result.test.vertices;
  // The noise of vertices is independent, so counts are binomial. With groups of equal size, Welch's t is Student's
  // with 6 degrees of freedom, around the effect over its error: the variance of a mean of 100 frames of the series is
  // ((1 + phi) / (1 - phi) - 2 phi / (100 (1 - phi)^2)) / 100.
  const double variance = (3 - 1 / (100 * 0.25)) / 100, shift = 1 / std::sqrt(variance / 2);
  double threshold = 1e9;  // of |t|, that exchanged labels gave
  for (std::size_t v = 0; v < file.n_vertices(); ++v) {
    if (result.test.p_max_t[v] <= 0.05) threshold = std::min(threshold, std::fabs(t.t[v]));
  }
  const boost::math::non_central_t around(6, shift);
  const double nominal = cdf(complement(around, threshold)) + cdf(around, -threshold);
  const auto [by_max_t, n] = share_of_planted(file, [&](std::size_t v) { return result.test.p_max_t[v] <= 0.05; });
  const auto [by_tfce, same] = share_of_planted(file, [&](std::size_t v) { return result.test.p_tfce[v] <= 0.05; });
  MESSAGE("found of ", n, " planted vertices: ", by_max_t, " by max-t, ", nominal, " expected; ", by_tfce, " by TFCE");
  CHECK(std::fabs(by_max_t - nominal) < three_deviations(nominal, n));
  // Neighbours help: no less than by max-t.
  CHECK(by_tfce > nominal - three_deviations(nominal, n));
  // Intervals hold the effect in 95 % of cases or slightly more: with so few replicates Welch's degrees of freedom are
  // conservative, by less than one percent.
  const auto [covered, all] = share_of_planted(file, [&](std::size_t v) { return t.low[v] < -1 && t.high[v] > -1; });
  MESSAGE("intervals that hold the effect: ", covered);
  CHECK(covered > 0.95 - three_deviations(0.95, all));
  CHECK(covered < 0.96 + three_deviations(0.95, all));
}

TEST_CASE("a run that drifts is no sample of a state, and the answer says so") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(4, 4, 100), -1, 12);
  {
    EnsembleFile file(path, true);
    std::vector<float> values(file.n_vertices());
    for (std::size_t f = 0; f < 100; ++f) {  // of the first replicate
      file.read_values(f, 0, values.size(), values.data());
      for (float& value : values) value += 0.02F * static_cast<float>(f);
      file.write(f, values, file.numbers(f));
    }
  }
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  REQUIRE(result.not_equilibrium.size() == 1);
  CHECK(result.not_equilibrium[0].find("replicate 1 of wild drifts: ") == 0);
  CHECK(result.replicates[0].drift.p <= 0.01 / 8);
  CHECK(result.replicates[1].drift.p > 0.01 / 8);
  std::ostringstream table;
  print_ensemble(table, file, result);
  CHECK(table.str().find("NOT AN EQUILIBRIUM ANSWER") != std::string::npos);
  const auto json = ensemble_json(file, result);
  CHECK(json.at("equilibrium").at("holds") == false);
  CHECK(json.at("equilibrium").at("reasons").size() == 1);
  CHECK(json.at("equilibrium").at("not_checked").empty());
  plant_file(folder.file("short.h5"), planted_plan(4, 4, 9), -1, 12);
  const EnsembleFile few(folder.file("short.h5"), false);
  CHECK(ensemble_json(few, analyse_ensemble(few, {})).at("equilibrium").at("not_checked").size() == 8);
}

TEST_CASE("a single run of few effective samples is no sample of a state") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(1, 1, 45), -1, 13);
  const EnsembleResult result = analyse_ensemble(EnsembleFile(path, false), {});
  REQUIRE(result.not_equilibrium.size() == 2);
  CHECK(result.not_equilibrium[0].find("wild has one replicate, of ") == 0);
}

TEST_CASE("replicates of few effective samples are one warning, which names the one of fewest") {
  const ScratchFolder folder;
  const auto warning_of = [&](const char* name, const EnsemblePlan& plan) {
    plant_file(folder.file(name), plan, -1, 14);
    const EnsembleResult result = analyse_ensemble(EnsembleFile(folder.file(name), false), {});
    const auto fewest = std::min_element(result.replicates.begin(), result.replicates.end(),
                                         [](const auto& a, const auto& b) { return a.effective < b.effective; });
    std::vector<std::string> found;
    for (const std::string& warning : result.warnings)
      if (warning.find("effective samples") != std::string::npos) found.push_back(warning);
    REQUIRE(found.size() == 1);
    CHECK(found[0].find("replicate " + fewest->name + " of " + fewest->group) != std::string::npos);
    return found[0];
  };
  CHECK(warning_of("all.h5", planted_plan(4, 4, 12)).find("8 of 8 replicates have fewer than 20 effective samples ") ==
        0);
  EnsemblePlan plan = planted_plan(4, 4, 100);
  plan.replicates[5].n_frames = 12;
  CHECK(warning_of("one.h5", plan).find("replicate ") == 0);
}

TEST_CASE("the conclusion comes first, and p only where something can be concluded") {
  const ScratchFolder folder;
  const auto answer = [&](const char* name, const EnsemblePlan& plan, double effect) {
    plant_file(folder.file(name), plan, effect, 14);
    const EnsembleFile file(folder.file(name), false);
    const EnsembleResult result = analyse_ensemble(file, {});
    std::ostringstream table;
    print_ensemble(table, file, result);
    CHECK(ensemble_json(file, result).at("conclusion") == result.conclusion);
    CHECK(table.str().find("conclusion   ") == 0);
    return std::pair(result, table.str());
  };
  const auto [few, few_table] = answer("few.h5", planted_plan(3, 3, 100), -1);
  CHECK(few.conclusion ==
        "NO CONCLUSION: 3 against 3 replicates have 20 permutations, so that no family-wise p can be below 0.1");
  CHECK(few_table.find(" p = ") == std::string::npos);
  CHECK(few_table.find("significant: not tested, since 3 against 3 replicates") != std::string::npos);
  const auto [short_runs, short_table] = answer("short.h5", planted_plan(1, 1, 12), -1);
  CHECK(short_runs.conclusion.find("NOT AN EQUILIBRIUM ANSWER, nothing is concluded about the states: wild has one") ==
        0);
  CHECK(short_table.find(" p = ") == std::string::npos);
  CHECK(short_table.find("significant: not tested, since ") != std::string::npos);
  const auto [runs, runs_table] = answer("runs.h5", planted_plan(1, 1, 400), -2);
  CHECK(runs.conclusion.find("these two runs differ on ") == 0);
  CHECK(runs.conclusion.find("nothing is concluded about the states") != std::string::npos);
  CHECK(runs_table.find("p (of these runs, not of the states) = ") != std::string::npos);
  const auto [states, states_table] = answer("states.h5", planted_plan(4, 4, 100), -1);
  CHECK(states.conclusion.find("the states, as these simulations sample them, differ on ") == 0);
  CHECK(states_table.find("   p = ") != std::string::npos);
}

TEST_CASE("a replicate is named by its file up to the first dot, which is not one that hides the file") {
  const std::vector<ReplicateRequest> replicates =
      replicates_of_groups({{"A", "x/run1.traj.dcd", ".hidden.pdb", "none"}});
  REQUIRE(replicates.size() == 3);
  CHECK(replicates[0].name == "run1");
  CHECK(replicates[1].name == ".hidden");
  CHECK(replicates[2].name == "none");
}

TEST_CASE("replicates of a file, or some of their frames, are compared in other groups") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(2, 2, 100), -2, 15);
  EnsembleFile file(path, false);
  relabel(file, replicates_of_groups({{"one", "wild/1", "mutant/2@0:49"}, {"two", "wild/2", "mutant/1@50:99"}}));
  CHECK(file.plan().groups() == std::vector<std::string>{"one", "two"});
  CHECK(file.plan().n_frames() == 300);
  CHECK(file.n_done() == 300);
  const EnsembleFile whole(path, false);
  std::vector<float> a(file.n_vertices()), b(file.n_vertices());
  file.read_values(299, 0, a.size(), a.data());
  whole.read_values(299, 0, b.size(), b.data());  // mutant/1 is the third of the file
  CHECK(a == b);
  file.read_values(100, 0, a.size(), a.data());
  whole.read_values(300, 0, b.size(), b.data());
  CHECK(a == b);
  const EnsembleResult result = analyse_ensemble(file, {});
  CHECK(result.groups[0].n_replicates == 2);
  const auto refused = [&](const std::vector<std::vector<std::string>>& groups, const std::string& text) {
    EnsembleFile other(path, false);
    try {
      relabel(other, replicates_of_groups(groups));
      FAIL(text);
    } catch (const InputError& error) {
      CHECK(std::string(error.what()).find(text) != std::string::npos);
    }
  };
  refused({{"one", "wild/3"}}, "has no replicate 'wild/3'; it has wild/1, wild/2, mutant/1, mutant/2");
  refused({{"one", "1"}}, "has more than one replicate '1'");
  refused({{"one", "wild/1@0:9"}, {"two", "wild/1@9:20"}},
          "wild, replicate 1, frame 9 is in wild/1@0:9 and in wild/1@9:20; a frame counts once");
  refused({{"one", "wild/1@3"}}, "wild/1@3 is one frame; a replicate needs two or more");
  refused({{"one", "wild/1@0:100"}}, "100");
}

TEST_CASE("without an effect nothing is found") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(4, 4, 100), 0, 6);
  const EnsembleResult result = analyse_ensemble(EnsembleFile(path, false), {});
  CHECK(result.patches.empty());
  CHECK(result.test.mean_abs_difference_p > 0.05);
  CHECK(result.noise.across == doctest::Approx(result.noise.replicates[0]).epsilon(0.1));
}

TEST_CASE("vertices that too many frames of a group do not trust are left out, and the share is said") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(4, 4, 100), -1, 7);
  {
    EnsembleFile file(path, true);
    std::vector<float> values(file.n_vertices());
    for (std::size_t f = 400; f < 800; f += 4) {  // a quarter of the mutants' frames
      file.read_values(f, 0, values.size(), values.data());
      std::vector<std::uint8_t> trusted(values.size(), 1);
      for (std::size_t v = 0; v < values.size() / 2; ++v) trusted[v] = 0;
      values[1] = std::numeric_limits<float>::quiet_NaN();  // has no counterpart
      file.write(f, values, file.numbers(f), trusted);
    }
  }
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  CHECK(result.tested[0] == 0);
  CHECK(result.tested.back() == 1);
  CHECK(std::isnan(result.test.p_tfce[0]));
  CHECK(result.groups[0].trusted[0] == 1);
  CHECK(result.groups[1].trusted[0] == doctest::Approx(0.75));
  double half = 0;
  for (std::size_t v = 0; v < result.tested.size() / 2; ++v) half += result.graph.area[v];
  CHECK(result.tested_share() == doctest::Approx(1 - half / result.area_A2));
  CHECK(result.replicates[0].trusted_area_fraction == doctest::Approx(1));
  CHECK(result.replicates[4].trusted_area_fraction == doctest::Approx(1 - 0.25 * half / result.area_A2));
  std::ostringstream table;
  print_ensemble(table, file, result);
  INFO(table.str());
  CHECK(table.str().find("%), which at least 90 % of each group's frames trust\n") != std::string::npos);
  const double share = 100 * result.tested_share();
  REQUIRE(result.warnings.size() == (share < 50 ? 1 : 0));
  EnsembleOptions lenient;
  lenient.most_missing = 0.3;
  const EnsembleResult more = analyse_ensemble(file, lenient);
  CHECK(more.tested[0] == 1);
  // What is not trusted in a frame does not count there.
  std::vector<float> values(file.n_vertices());
  double sum = 0;
  for (std::size_t f = 400; f < 800; ++f) {
    file.read_all_values(f, 0, values.size(), values.data());
    REQUIRE(std::isfinite(values[0]));
    if (f % 4 != 0) sum += static_cast<double>(values[0]);
  }
  CHECK(more.groups[1].mean[0] == doctest::Approx(sum / 300));
}

TEST_CASE("one replicate a group is a statement about the runs, and says so") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(1, 1, 600), -1, 8);
  const EnsembleResult result = analyse_ensemble(EnsembleFile(path, false), {});
  CHECK(result.test.inference == Inference::kWithinRuns);
  REQUIRE(!result.patches.empty());
  CHECK(result.patches[0].residues.front().first == "ALA 1");
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0].find("a group has one replicate: p-values and intervals will be of these runs only") == 0);
  CHECK(result.patch_tests.difference[0] == doctest::Approx(-1).epsilon(0.15));
}

TEST_CASE("one group is described without a test") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(3, 0, 100), 0, 9);
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  CHECK_FALSE(result.compares);
  CHECK(result.groups[0].deviation[0] == doctest::Approx(1).epsilon(0.2));
  const std::vector<std::string> written = write_ensemble(folder.file("out"), file, result);
  CHECK(written.size() == 3);
}

TEST_CASE("results are the same bytes at any number of threads and again") {
  const ScratchFolder folder;
  plant_file(folder.file("a.h5"), planted_plan(4, 4, 50), -1, 10);
  const EnsembleFile file(folder.file("a.h5"), false);
  for (const char* name : {"x", "y"}) write_ensemble(folder.file(name), file, analyse_ensemble(file, {}));
  for (const char* ending : {".json", ".vtp", ".residues.csv", ".patches.csv", ".patch_series.csv"})
    CHECK(read_file(folder.file(std::string("x") + ending)) == read_file(folder.file(std::string("y") + ending)));
  const auto json = nlohmann::json::parse(read_file(folder.file("x.json")));
  CHECK(json.at("test").at("n_permutations") == 70);
  CHECK(json.at("patches").at(0).at("residues").at(0).at("residue") == "ALA 1");
  std::ostringstream table;
  print_ensemble(table, file, analyse_ensemble(file, {}));
  CHECK(table.str().find("labels exchanged in all 70 ways") != std::string::npos);
  std::string line;
  for (std::istringstream lines(table.str()); std::getline(lines, line);) {
    CAPTURE(line);
    CHECK((line.size() <= 100 || line.rfind("warning", 0) == 0 || line.rfind("significant", 0) == 0));
  }
}

TEST_CASE("frames against frames, and the component that was planted") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  plant_file(path, planted_plan(2, 2, 20), -4, 11);
  const EnsembleFile file(path, false);
  const EnsembleResult result = analyse_ensemble(file, {});
  const StateTable states = compare_states(file, result);
  REQUIRE(states.size() == 80);
  CHECK(states.area_fraction == doctest::Approx(1));
  // One pair from the values.
  std::vector<float> a(file.n_vertices()), b(file.n_vertices());
  file.read_values(3, 0, a.size(), a.data());
  file.read_values(61, 0, b.size(), b.data());
  double difference = 0, squares = 0, product = 0, norms = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const double x = a[v], y = b[v], w = result.graph.area[v] / result.area_A2;
    difference += w * std::fabs(x - y);
    squares += w * (x - y) * (x - y);
    product += w * x * y;
    norms += w * (x * x + y * y);
  }
  const espdiff::Metrics pair = states.sums.metrics(3, 61);
  CHECK(pair.mean_abs_difference == doctest::Approx(difference));
  CHECK(states.sums.metrics(61, 3).mean_abs_difference == pair.mean_abs_difference);
  CHECK(pair.rms_difference == doctest::Approx(std::sqrt(squares)));
  CHECK(pair.hodgkin_index == doctest::Approx(2 * product / norms));
  CHECK(states.sums.metrics(5, 5).mean_abs_difference == 0);
  // The effect of -4 is the first component: 2 for one standard deviation, since half of the frames have it.
  const auto& first = states.components[0];
  CHECK(first.share > 2 * states.components[1].share);
  double sum = 0, spread = 0;
  for (const double score : first.scores) {
    sum += score;
    spread += score * score;
  }
  CHECK(sum == doctest::Approx(0).scale(1));
  CHECK(spread / 80 == doctest::Approx(1));
  double inside = 0, outside = 0, area_inside = 0, area_outside = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const Vec3d& p = file.surface().positions[v];
    const bool planted = p.x > 0 && p.y > 8;
    (planted ? inside : outside) += result.graph.area[v] * first.mode[v];
    (planted ? area_inside : area_outside) += result.graph.area[v];
  }
  CHECK(inside / area_inside == doctest::Approx(2).epsilon(0.1));
  CHECK(std::fabs(outside / area_outside) < 0.1);
  std::ostringstream components;
  write_components(components, file, states);
  CHECK(components.str().rfind("group,replicate,frame,component_1", 0) == 0);
}

TEST_CASE("values that do not change, and missing frames, are refused") {
  const ScratchFolder folder;
  const std::string path = folder.file("a.h5");
  EnsembleFile::create(path, planted_plan(2, 2, 5), planted_template(1));
  EnsembleFile file(path, true);
  CHECK(message_of([&] { analyse_ensemble(file, {}); }) == path + " has 0 of 20 frames; resume computes the others");
  for (std::size_t f = 0; f < 20; ++f) file.write(f, std::vector<float>(file.n_vertices(), 0.5F), {});
  CHECK(message_of([&] { analyse_ensemble(file, {}); }) ==
        "the potentials of replicate 1 of wild do not change from frame to frame; are its frames copies of one "
        "structure?");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t f = 0; f < 20; ++f) {
    std::vector<float> values(file.n_vertices(), nan);
    values[f % 5] = static_cast<float>(f);
    values[(f + 1) % 5] = 2;
    values[(f + 2) % 5] = 3 * static_cast<float>(f * f);
    file.write(f, values, {});
  }
  CHECK(message_of([&] {
          analyse_ensemble(file, {});
        }).find("no vertex of the template is trusted in 90 % of each group's frames") == 0);
  EnsembleOptions options;
  options.equilibration = parse_equilibration("4");
  CHECK(message_of([&] { analyse_ensemble(file, options); }) ==
        "equilibration 4 leaves fewer than two of the 5 frames of replicate 1 of wild; cut off less");
  CHECK(message_of([&] { parse_equilibration("-3"); }) ==
        "equilibration: '-3' is not none, auto, or a number of frames");
}

TEST_CASE("designs that cannot show anything are named beforehand") {
  CHECK(design_warning(planted_plan(4, 4, 5)).empty());
  CHECK(design_warning(planted_plan(3, 0, 5)).empty());
  CHECK(design_warning(planted_plan(3, 3, 5)) ==
        "3 against 3 replicates can be exchanged in 20 ways: no family-wise p can be below 0.1, whatever the frames "
        "are; 4 against 4 reach 0.029");
  EnsemblePlan plan = planted_plan(2, 2, 5);
  plan.replicates[1].name = "1";
  CHECK(message_of([&] { check_replicates(plan.replicates); }) ==
        "group wild has two replicates named 1; name them apart");
  plan = planted_plan(2, 2, 5);
  plan.replicates[3].sha256 = plan.replicates[0].sha256;
  CHECK(message_of([&] { check_replicates(plan.replicates); }) ==
        "2 of replicate 2 of mutant has the same content as replicate 1 of wild (1); a replicate counts once");
  plan = planted_plan(2, 2, 5);
  plan.replicates[2].n_frames = 1;
  CHECK(message_of([&] { check_replicates(plan.replicates); }) ==
        "replicate 1 of mutant has 1 frame; a replicate needs two or more");
}

TEST_SUITE_END();
