// real_nulls.cpp: simulations of tests/data/ensembles against themselves: no difference; against their mutant: one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/engine.h"
#include "engine/select_engine.h"
#include "ensemble/balanced_splits.h"
#include "ensemble/ensemble_study.h"
#include "ensemble/file/ensemble_file.h"
#include "statistics/replicate_columns.h"
#include "statistics/test_replicates.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;  // NOLINT: a test

namespace {

double smallest(const std::vector<double>& p) {
  double least = 1;
  for (const double value : p) least = std::isfinite(value) ? std::min(least, value) : least;
  return least;
}

/// Trp-cage and its mutant K8Q: four replicates of five frames each, on a coarse grid.
EnsembleAnswer trpcage(const std::string& output) {
  const std::string data = ESPDIFF_SOURCE_DIR "/tests/data/ensembles/trpcage_";
  EnsembleStudy study;
  for (const std::string group : {"wild", "mutant"}) {
    for (const char* number : {"1", "2", "3", "4"}) {
      ReplicateRequest replicate;
      replicate.group = group;
      replicate.name = number;
      replicate.files = {data + group + "_" + number + ".pdb.gz"};
      study.inputs.replicates.push_back(replicate);
    }
    study.inputs.charges[group] = data + group + ".pqr";
  }
  study.inputs.frames = "0:20:99";
  study.inputs.potential.potential = "coulomb";
  study.options = ensemble_options({{"grid-spacing", "1.6"}});
  study.run.output = output;
  return run_study(
      study, [] { return select_engine({DeviceChoice::kCpu}, 0); }, Progress(), [](const Message&) {});
}

}  // namespace

TEST_SUITE_BEGIN("real nulls");

TEST_CASE("replicates of the same states, in all splits, do not differ; the two states do") {
  const ScratchFolder folder;
  const EnsembleAnswer answer = trpcage(folder.file("out"));
  const EnsembleFile& file = *answer.file;
  const MeshGraph& graph = answer.result->graph;
  const EnsembleColumns columns(file, std::vector<std::size_t>(8, 0));
  const std::vector<ReplicateColumns> replicates = summarize_columns(columns);
  std::vector<std::vector<double>> means(8);
  for (std::size_t r = 0; r < 8; ++r) {
    for (const SeriesSummary& s : replicates[r].columns) means[r].push_back(s.mean);
  }
  const std::vector<std::size_t> wild = file.plan().replicates_of("wild"), mutant = file.plan().replicates_of("mutant");
  // Half of each state against the other half of each: 18 splits and their mirror images, each significant with a
  // chance of 2 / 70. Three distinct ones or more: 1.3 % by the binomial distribution.
  int n_max_t = 0, n_tfce = 0;
  const auto splits = balanced_splits(wild, mutant);
  REQUIRE(splits.size() == 36);
  for (const auto& [one, two] : splits) {
    std::vector<std::vector<double>> some;
    for (const auto* group : {&one, &two}) {
      for (const std::size_t r : *group) some.push_back(means[r]);
    }
    const SurfaceTest test = test_replicates(some, one.size(), graph, {});
    n_max_t += smallest(test.p_max_t) <= 0.05 ? 1 : 0;
    n_tfce += smallest(test.p_tfce) <= 0.05 ? 1 : 0;
  }
  MESSAGE("significant without a difference: ", n_max_t, " of 36 by max-t, ", n_tfce, " by TFCE");
  CHECK(n_max_t <= 4);
  CHECK(n_tfce <= 4);
  // First halves of the runs against the second ones.
  for (const auto* group : {&wild, &mutant}) {
    std::vector<std::vector<double>> halves;
    for (const std::size_t r : *group) halves.push_back(replicates[r].first_half);
    for (const std::size_t r : *group) halves.push_back(replicates[r].second_half);
    CHECK(smallest(test_replicates(halves, group->size(), graph, {}).p_tfce) > 0.05);
  }
  // The states differ where the mutated residue is.
  REQUIRE(!answer.result->patches.empty());
  const EnsemblePatch& patch = answer.result->patches.front();
  CHECK(std::any_of(patch.residues.begin(), patch.residues.end(),
                    [](const auto& share) { return share.first.find(" 8 ") != std::string::npos; }));
  CHECK(answer.result->patch_tests.difference.front() < 0);
}

TEST_SUITE_END();
