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
  double size = 1;                   ///< of the changed comparison: its atoms, of those of the present one
};

/// The states that got their charges from PDB2PQR.
struct PreparedStates {
  bool source = false, target = false;
};

/// The changes that are worth a trial, the most likely one first: the force field of the state that has charges for the
/// other, which was prepared; the chains that were compared, without the others;
/// each chain by its own motion; one pair of chains; no tails and loops that only one state has; the mapping in the
/// other direction; motions that are chosen by need; one protonation for both states.
/// @param given    names of the settings that were given
std::vector<WayOn> ways_on(const CompareResult& result, const Molecule& source, const Molecule& target,
                           const std::vector<std::string>& given, PreparedStates prepared);

/// Whether the trial of a change is affordable: all trials may take a minute, or as long as the answer took.
/// @param once_s  seconds of the present comparison
/// @param spent_s seconds of the trials so far
bool has_time_for(const WayOn& way, double once_s, double spent_s);

}  // namespace espdiff::cli
