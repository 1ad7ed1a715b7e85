// running_map.cpp: Welford's running mean and variance of maps, and of the means of blocks of them.
#include "potential/running_map.h"

#include <cmath>
#include <utility>

#include "base/error.h"

namespace espdiff {
namespace {

/// Adds the n-th value (from 1) to a running mean and sum of squared deviations.
void add_value(double value, double n, double& mean, double& squares) {
  const double before = value - mean;
  mean += before / n;
  squares += before * (value - mean);
}

}  // namespace

bool same_lattice(const Lattice& a, const Lattice& b) {
  return a.size == b.size && a.origin == b.origin && a.step[0] == b.step[0] && a.step[1] == b.step[1] &&
         a.step[2] == b.step[2];
}

RunningMap::RunningMap(std::size_t frames_per_block) : frames_per_block_(frames_per_block) {
  if (frames_per_block < 1) throw InputError("blocks of 0 frames; give at least 1 frame a block");
}

void RunningMap::add(Grid map) {
  const std::size_t n_points = map.values.size();
  if (n_points == 0 || n_points != map.lattice.n_points())
    throw InputError(map.name + ": " + std::to_string(n_points) + " values for a lattice of " +
                     std::to_string(map.lattice.n_points()) + " points cannot be averaged");
  if (n_frames_ == 0) {
    lattice_ = map.lattice;
    unit_ = map.unit;
    periodic_ = map.periodic;
    first_ = std::move(map.values);
    n_frames_ = 1;
    n_blocks_ = frames_per_block_ == 1 ? 1 : 0;
    return;
  }
  if (!same_lattice(lattice_, map.lattice) || map.unit != unit_)
    throw InputError(map.name + ": the lattice or unit differs from that of the maps before; sample all frames on one");
  periodic_ = periodic_ && map.periodic;
  if (!first_.empty()) {
    for (std::vector<double>* values : {&mean_, &squares_, &block_, &block_mean_, &block_squares_})
      values->assign(n_points, 0.0);
    n_frames_ = n_blocks_ = 0;
    accumulate(std::exchange(first_, {}));
  }
  accumulate(map.values);
}

void RunningMap::accumulate(const std::vector<float>& frame) {
  ++n_frames_;
  const std::size_t in_block = (n_frames_ - 1) % frames_per_block_ + 1;
  const bool ends_block = in_block == frames_per_block_;
  if (ends_block) ++n_blocks_;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const double value = static_cast<double>(frame[i]);
    add_value(value, static_cast<double>(n_frames_), mean_[i], squares_[i]);
    block_[i] += (value - block_[i]) / static_cast<double>(in_block);
    if (!ends_block) continue;
    add_value(block_[i], static_cast<double>(n_blocks_), block_mean_[i], block_squares_[i]);
    block_[i] = 0;
  }
}

Grid RunningMap::filled(const std::vector<double>& values, double scale, bool root, PotentialUnit unit,
                        const std::string& what) const {
  Grid grid;
  grid.lattice = lattice_;
  grid.unit = unit;
  grid.periodic = periodic_;
  grid.name = what + " of " + std::to_string(n_frames_) + " frames";
  grid.values.reserve(values.size());
  for (const double value : values)
    grid.values.push_back(static_cast<float>(root ? std::sqrt(scale * value) : scale * value));
  return grid;
}

Grid RunningMap::mean() const {
  if (n_frames_ == 0) throw InputError("the mean of no frames; add at least one");
  Grid grid = filled(mean_, 1, false, unit_, "mean");
  if (!first_.empty()) grid.values = first_;
  return grid;
}

Grid RunningMap::variance() const {
  if (n_frames_ < 2)
    throw InputError("the variance of " + std::to_string(n_frames_) + " frames; at least 2 are needed");
  return filled(squares_, 1 / static_cast<double>(n_frames_ - 1), false, PotentialUnit::kUnknown, "variance");
}

Grid RunningMap::standard_error() const {
  if (n_blocks_ < 2)
    throw InputError("the standard error from " + std::to_string(n_blocks_) + " whole blocks of " +
                     std::to_string(frames_per_block_) +
                     " frames; at least 2 are needed: take more frames, or smaller "
                     "blocks");
  const double n = static_cast<double>(n_blocks_);
  return filled(block_squares_, 1 / (n * (n - 1)), true, unit_, "standard error");
}

}  // namespace espdiff
