// weighted_order.h: values in ascending order with their weights, for quantiles over an area.
#pragma once

#include <vector>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Values sorted in ascending order with their weights; NaN last, or first if its sign bit is set. They stay on the
/// device.
class WeightedOrder {
 public:
  /// Waits for nothing. @param values, weights [point]
  WeightedOrder(const Buffer<float>& values, const Buffer<float>& weights);

  /// Adds what quantiles() needs first to `reads`, which must wait before.
  void read_sums(HostReads& reads);

  /// For each share the smallest value such that the weights up to it make that share of `total`; the largest value if
  /// they never do, as for an infinite share. Adds float weights in double precision in ascending order of values, in
  /// chunks of kReductionChunk. Waits once.
  /// @param shares in ascending order
  std::vector<float> quantiles(double total, const std::vector<double>& shares) const;

 private:
  Buffer<std::uint32_t> keys_, weights_;  // the bits of the values, in integers' order, and of the weights
  Buffer<double> chunks_;
  std::vector<double> sums_;  // of the chunks
};

}  // namespace espdiff::ESPDIFF_BACKEND
