// running_map.h: mean, variance and error bar of a potential over frames, point by point.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Adds up maps on one lattice, in double precision, by Welford's method (Technometrics 4, 419 (1962)), which keeps its
/// digits if the mean is much larger than the deviations. Means of successive blocks of frames give an error bar
/// that is valid for correlated frames (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989)).
/// Memory: 40 bytes a point; 4 with a single frame.
class RunningMap {
 public:
  /// @param frames_per_block at least 1
  /// @throws InputError
  explicit RunningMap(std::size_t frames_per_block = 1);

  /// @throws InputError when lattice or unit differ from the first map's, or the map has no points
  void add(Grid map);

  std::size_t n_frames() const { return n_frames_; }
  /// Of the lattice; 0 before the first frame.
  std::size_t n_points() const { return lattice_.n_points(); }
  /// Number of full blocks. Frames of an incomplete block enter mean and variance only.
  std::size_t n_blocks() const { return n_blocks_; }

  /// @throws InputError before the first frame
  Grid mean() const;
  /// sum (x - mean)^2 / (n - 1), in the squared unit (Grid::unit is kUnknown). @throws InputError below 2 frames
  Grid variance() const;
  /// sqrt(variance of the blocks' means / number of blocks). @throws InputError below 2 whole blocks
  Grid standard_error() const;

 private:
  Grid filled(const std::vector<double>& values, double scale, bool root, PotentialUnit unit,
              const std::string& what) const;

  void accumulate(const std::vector<float>& frame);

  std::size_t frames_per_block_, n_frames_ = 0, n_blocks_ = 0;
  Lattice lattice_;
  PotentialUnit unit_ = PotentialUnit::kUnknown;
  bool periodic_ = false;
  std::vector<float> first_;                        // [point] the first frame, until a second one comes
  std::vector<double> mean_, squares_;              // [point] of frames: mean, sum of squared deviations
  std::vector<double> block_;                       // [point] mean of the block that is being filled
  std::vector<double> block_mean_, block_squares_;  // [point] of the blocks' means
};

/// Whether two lattices have the same points.
bool same_lattice(const Lattice& a, const Lattice& b);

}  // namespace espdiff
