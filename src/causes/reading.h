// reading.h: which mean of potential differences the causes are asked of.
#pragma once

#include <cstdint>
#include <string>

namespace espdiff {

/// A reading is a weighted sum of potentials over a surface; its weights are shares of area.
enum class ReadingOf {
  kWhole,   ///< the mean absolute difference: weights times the sign of the difference
  kRegion,  ///< the mean difference over the region
  kPatch,   ///< the same over a patch
  kResidue  ///< the same over the surface of one residue of the source
};

struct ReadingRequest {
  ReadingOf of = ReadingOf::kWhole;
  std::string patch;  ///< its name
  std::string chain;  ///< of a residue; empty for any
  std::int32_t number = 0;
  char insertion_code = ' ';
};

/// Reads `whole`, `region`, `patch NAME`, or `residue [CHAIN:]NUMBER` (with an insertion code perhaps).
/// @throws InputError with these forms
ReadingRequest parse_reading(const std::string& text);

}  // namespace espdiff
