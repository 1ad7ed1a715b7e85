// planted_errors.cpp: errors planted into real structures are caught, each for its reason, and right pairs are not
// refused.

#include <doctest/doctest.h>

#include <filesystem>

#include "input_checks/planted_cases.h"
#include "support/test_data.h"

using namespace espdiff_test;

TEST_SUITE_BEGIN("planted errors");

TEST_CASE("planted errors are caught for their reason, and right pairs under wrong names are mapped") {
  const std::string folder = data_folder();
  if (folder.empty()) {
    MESSAGE("SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder");
    return;
  }
  for (const PlantedCase& planted : planted_cases(folder)) {
    const PlantedOutcome outcome = run_case(planted);
    CAPTURE(planted.name);
    CAPTURE(outcome.rmsd_A);
    CAPTURE(outcome.reasons);
    CHECK(outcome.right);
  }
}

TEST_CASE("easy pairs are trustworthy") {
  const std::string folder = data_folder();
  if (folder.empty()) {
    MESSAGE("SKIPPED: real inputs are absent; set ESPDIFF_DATA to their folder");
    return;
  }
  const std::vector<PlantedCase> all = easy_pairs(folder);
  // All of them: bench/certificate_rates.
  int n_easy = 0;
  for (std::size_t k = 0; k < all.size(); k += 8) {
    const PlantedOutcome outcome = run_case(all[k]);
    if (!(outcome.rmsd_A < 2)) continue;  // not easy after all
    ++n_easy;
    CAPTURE(all[k].name);
    CAPTURE(outcome.reasons);
    CHECK(outcome.right);
  }
  CHECK(n_easy >= 5);
}

TEST_SUITE_END();
