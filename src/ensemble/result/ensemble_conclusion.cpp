// ensemble_conclusion.cpp: the answer in one sentence, before its numbers.
#include "ensemble/result/ensemble_conclusion.h"

#include <cmath>

#include "base/formatted.h"
#include "ensemble/result/ensemble_result.h"

namespace espdiff {
namespace {

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

/// "differ on 104.1 A^2 of 1651.6 A^2 tested, family-wise p <= 0.05; most at GLN 8 of chain A, by -1.181 kT/e (...)"
std::string differences(const EnsembleResult& result, const std::string& unit) {
  const EnsemblePatch& patch = result.patches.front();
  const PlaceTests& t = result.patch_tests;
  return formatted(
      " differ on %.1f A^2 of %.1f A^2 tested (family-wise p <= %g); the largest patch is at %s, by %.3f%s "
      "(%.3f to %.3f)",
      result.significant_area_A2, result.tested_area_A2, result.options.alpha, patch.residues.front().first.c_str(),
      t.difference.front(), (unit.empty() ? "" : " " + unit).c_str(), t.low.front(), t.high.front());
}

}  // namespace

std::string conclusion_of(const EnsembleResult& result, const std::string& unit) {
  const bool within_runs = result.test.inference == Inference::kWithinRuns;
  if (!result.not_equilibrium.empty())
    return "NOT AN EQUILIBRIUM ANSWER, nothing is concluded about the " +
           std::string(result.compares ? "states: " : "state: ") + joined(result.not_equilibrium);
  if (!result.compares) return "one group is described; a second one can be compared with it";
  if (!result.has_p()) return "NO CONCLUSION: " + result.why_no_p();
  const std::string what = within_runs ? "these two runs" : "the states, as these simulations sample them,";
  const std::string limits =
      within_runs ? "; with one replicate a group nothing is concluded about the states, whose runs may differ as much"
                  : "";
  if (!result.patches.empty()) return what + differences(result, unit) + limits;
  return "no difference was found between " + std::string(within_runs ? "these two runs" : "the states") +
         formatted(" (family-wise p > %g everywhere), which does not show that they are equal: see the intervals",
                   result.options.alpha) +
         limits;
}

std::string EnsembleResult::why_no_p() const {
  if (!test.no_p.empty()) return test.no_p;
  if (test.smallest_p <= options.alpha) return "";
  return formatted("%zu against %zu %s have %zu permutations, so that no family-wise p can be below %.3g",
                   n_exchanged_first(), n_exchanged() - n_exchanged_first(),
                   test.inference == Inference::kReplicates ? "replicates" : "blocks of frames", test.n_permutations,
                   test.smallest_p);
}

std::size_t EnsembleResult::n_exchanged() const {
  return test.inference == Inference::kReplicates ? replicates.size() : test.block_means.size();
}

std::size_t EnsembleResult::n_exchanged_first() const {
  return test.inference == Inference::kReplicates ? groups.front().n_replicates : test.n_first_blocks;
}

}  // namespace espdiff
