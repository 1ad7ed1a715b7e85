// verify.h: recomputes a result's numbers from its files, by other code than made them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace espdiff {

/// One number of OUT.json, and what the files give for it.
struct VerifiedLine {
  std::string name;  ///< JSON pointer in OUT.json
  double recorded = 0, recomputed = 0;
  double tolerance = 0;  ///< in the number's unit
  bool agrees() const { return std::fabs(recorded - recomputed) <= tolerance; }
};

struct Verification {
  std::vector<VerifiedLine> lines;
  std::vector<std::string> not_recomputed;  ///< numbers, with the reason
  bool agrees() const {
    return std::all_of(lines.begin(), lines.end(), [](const VerifiedLine& line) { return line.agrees(); });
  }
};

/// Reads OUT.json and OUT.vtp, and the structures and maps that OUT.json names. Areas, metrics, distances, corrupt and
/// flipped area, unmatched area, area ratios, slip's quantiles and the potentials at the vertices are computed again in
/// double precision. The target's surface is rebuilt from its atoms on a lattice of half the spacing by VTK's flying
/// edges; distances are VTK's, at points inside the triangles. Nothing of the engine is used.
/// @param prefix OUT
/// @throws IoError, FormatError (files that are absent or damaged), InputError (an input that has changed since)
Verification verify(const std::string& prefix);

}  // namespace espdiff
