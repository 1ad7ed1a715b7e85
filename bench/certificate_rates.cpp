// certificate_rates.cpp: how many planted errors the certificate catches, and how many easy pairs it refuses; the
// tables of bench/study_notes.md.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

#include "input_checks/planted_cases.h"
#include "real_pairs.h"

namespace {

using namespace espdiff_test;

/// @returns the number of cases with the wrong verdict
int print(const char* title, const std::vector<PlantedCase>& cases, const std::string& domains) {
  std::printf("## %s\n\n| case | RMSD A | slip beyond 3 A %% | same residue %% | verdict | reasons |\n", title);
  std::printf("|---|---|---|---|---|---|\n");
  int n_wrong = 0, n_easy = 0;
  for (const PlantedCase& planted : cases) {
    const PlantedOutcome outcome = run_case(planted, 0, domains);
    // A pair that is farther than 2 A is not easy.
    const bool counts = planted.reason.size() > 0 || outcome.rmsd_A < 2;
    n_easy += counts ? 1 : 0;
    n_wrong += counts && !outcome.right ? 1 : 0;
    std::printf("| %s | %.2f | %.2f | %.1f | %s%s%s | %s |\n", planted.name.c_str(), outcome.rmsd_A,
                100 * outcome.slip_area_fraction, 100 * outcome.same_residue,
                outcome.trustworthy ? "trustworthy" : "not trustworthy", outcome.right ? "" : " (WRONG)",
                counts ? "" : " (not counted)", outcome.reasons.c_str());
    std::fflush(stdout);
  }
  std::printf("\n%d of %d wrong\n\n", n_wrong, n_easy);
  return n_wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = espdiff_bench::data_folder();
  if (folder.empty()) {
    std::fprintf(stderr, "certificate_rates: real inputs are absent; set ESPDIFF_DATA to their folder\n");
    return 2;
  }
  // certificate_rates [--planted] [DOMAINS [PART OF A CASE'S NAME]]
  const bool planted_only = argc > 1 && std::strcmp(argv[1], "--planted") == 0;
  const std::string domains = argc > (planted_only ? 2 : 1) ? argv[planted_only ? 2 : 1] : "as-needed";
  const int n_used = planted_only ? 3 : 2;
  const std::string part = argc > n_used ? argv[n_used] : "";
  const auto chosen = [&](std::vector<PlantedCase> cases) {
    cases.erase(std::remove_if(cases.begin(), cases.end(),
                               [&](const PlantedCase& c) { return c.name.find(part) == std::string::npos; }),
                cases.end());
    return cases;
  };
  int n_wrong = print("Planted errors", chosen(planted_cases(folder)), domains);
  if (!planted_only) n_wrong += print("Easy pairs", chosen(easy_pairs(folder)), domains);
  return n_wrong == 0 ? 0 : 1;
}
