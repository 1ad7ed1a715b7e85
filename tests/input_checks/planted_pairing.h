// planted_pairing.h: errors of correspondence planted into two copies of one protein, and what the checks of the inputs
// say of them; no surface is made.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "certificate/result.h"

namespace espdiff_test {

/// A pair with an error of one kind.
struct PlacedError {
  std::string kind;
  /// Must stand in a warning; empty where the pair is right and must not be refused, "=" where also each atom must be
  /// paired with itself.
  std::string text;
  std::pair<espdiff::Molecule, espdiff::Molecule> pair;
};

/// Exchanged side chains, shifted strands and helices, a turned helix, moved cofactors, a turned chain, and right pairs
/// that look wrong.
/// @param a, b copies of one protein, of one chain each  @param number varies where the errors are
std::vector<PlacedError> pairing_errors(const espdiff::Molecule& a, const espdiff::Molecule& b, std::size_t number);

/// The warnings of a pair, as compare makes them; what refuses begins with "*".
/// @param seconds receives the processor time of the checks, added
std::vector<std::string> warnings_of(const PlacedError& error, espdiff::Alignment& alignment,
                                     double* seconds = nullptr);

bool is_judged_rightly(const PlacedError& error, const espdiff::Alignment& alignment,
                       const std::vector<std::string>& warnings);

}  // namespace espdiff_test
