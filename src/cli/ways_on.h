// ways_on.h: what may turn a comparison that is not trusted into one that is.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/message.h"

namespace espdiff {
struct CompareResult;
struct Molecule;
}  // namespace espdiff

namespace espdiff::cli {

/// A change of a comparison.
struct WayOn {
  std::string what;                  ///< "source and target exchanged"
  bool exchanges = false;            ///< source and target
  std::vector<NamedOption> options;  ///< given in addition, or instead of earlier values
};

/// The changes that are worth a trial, the most likely one first: the chains that were compared, without the others;
/// one pair of chains; the mapping in the other
/// direction; motions that are chosen by need; one protonation for both states.
/// @param given    names of the settings that were given
/// @param prepared whether both states got their charges from PDB2PQR
std::vector<WayOn> ways_on(const CompareResult& result, const Molecule& source, const Molecule& target,
                           const std::vector<std::string>& given, bool prepared);

}  // namespace espdiff::cli
