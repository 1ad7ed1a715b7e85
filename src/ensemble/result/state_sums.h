// state_sums.h: sums over the template's surface for each pair of frames: all that differences of two frames are made
// of.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/potential_sums.h"

namespace espdiff {

class EnsembleFile;

/// Sums over the vertices where both frames of a pair are trusted. Pairs of n frames: i with j at [i * (i + 1) / 2 +
/// j], j at most i; a is of frame j, b of frame i.
struct StateSums {
  std::size_t n = 0;
  std::vector<PotentialSums> pairs;
  std::vector<double> complete;  ///< products a b over the vertices that every frame has, trusted or not
  double complete_area_A2 = 0;

  static std::size_t place(std::size_t i, std::size_t j) { return i * (i + 1) / 2 + j; }
  /// @param source, target frames; a is of the source
  Metrics metrics(std::size_t source, std::size_t target) const;
};

/// Adds up all pairs. Values are read in blocks; memory grows with the square of the number of frames. The same bits at
/// any number of threads.
/// @param frames  numbers in the file
/// @param weights [vertex] area; 0 where it does not count
StateSums sum_states(const EnsembleFile& file, const std::vector<std::size_t>& frames,
                     const std::vector<double>& weights);

/// Some columns of all frames, in double precision.
class StateBlock {
 public:
  StateBlock(const EnsembleFile& file, const std::vector<std::size_t>& frames) : file_(file), frames_(frames) {}

  /// @param end of the columns, excluded
  void read(std::size_t begin, std::size_t end);
  std::size_t width() const { return width_; }
  /// [column of the block]; 0 where the frame has no value.
  const double* values(std::size_t frame) const { return &values_[frame * width_]; }
  /// [column of the block] 1 where the frame has a trusted value, otherwise 0.
  const double* trusted(std::size_t frame) const { return &trusted_[frame * width_]; }
  /// Whether every frame has a value, trusted or not.
  bool is_complete(std::size_t column) const;

 private:
  const EnsembleFile& file_;
  const std::vector<std::size_t>& frames_;
  std::size_t width_ = 0;
  std::vector<double> values_, trusted_;
  std::vector<char> complete_;  // [column of the block]
};

/// How many columns are read at a time.
constexpr std::size_t kStateBlock = 256;

}  // namespace espdiff
