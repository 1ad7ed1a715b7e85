// automatic_range.cpp: the end of a colour scale when none is given.
#include "plot/automatic_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace espdiff {

double round_up_nicely(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  // The tolerance keeps 0.3, which is 3.0000000000000004e-1 after the division, from being rounded up to 0.4.
  for (const double factor : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (value <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

namespace {

/// Values that are zero, or nearly: less than a thousandth of the greatest.
void leave_out_zeros_if_most(std::vector<float>& magnitudes) {
  const float least = *std::max_element(magnitudes.begin(), magnitudes.end()) / 1000;
  const auto end = std::partition(magnitudes.begin(), magnitudes.end(), [least](float value) { return value > least; });
  if (end != magnitudes.begin() && 2 * (end - magnitudes.begin()) < magnitudes.end() - magnitudes.begin())
    magnitudes.erase(end, magnitudes.end());
}

}  // namespace

double automatic_limit(const std::vector<float>& values, double percentile) {
  std::vector<float> magnitudes;
  magnitudes.reserve(values.size());
  for (const float value : values) {
    if (std::isfinite(value)) magnitudes.push_back(std::abs(value));
  }
  if (magnitudes.empty()) return 1;
  leave_out_zeros_if_most(magnitudes);
  const auto rank = static_cast<std::ptrdiff_t>(percentile / 100 * static_cast<double>(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), magnitudes.begin() + rank, magnitudes.end());
  return round_up_nicely(magnitudes[static_cast<std::size_t>(rank)]);
}

}  // namespace espdiff
