// planted_cases.h: real structures with an error planted into them, which a certificate must find, and real pairs in
// which it must find none.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff_test {

struct PlantedCase {
  std::string name;
  /// Part of a reason that must be given; empty if the pair must be trustworthy. "|" separates texts of which any
  /// counts. A pair that is refused as input counts as caught.
  std::string reason;
  std::vector<std::string> files;  ///< what load() reads
  std::function<std::pair<espdiff::Molecule, espdiff::Molecule>()> load;
};

/// @param folder of the real inputs
std::vector<PlantedCase> planted_cases(const std::string& folder);

/// Easy pairs: the same protein, RMSD below 2 A, prepared alike.
std::vector<PlantedCase> easy_pairs(const std::string& folder);

/// What became of one case.
struct PlantedOutcome {
  bool trustworthy = false, right = false;
  double rmsd_A = 0, slip_area_fraction = 0, same_residue = 0;
  std::string reasons;  ///< or the error
};
/// @param domains as the setting of that name
PlantedOutcome run_case(const PlantedCase& planted, int threads = 0, const std::string& domains = "as-needed");

}  // namespace espdiff_test
