// cause_numbers.h: how the numbers of one reading's causes are written.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "base/formatted.h"
#include "causes/causes.h"

namespace espdiff {

/// Numbers of one reading, all with the decimals that give its largest two digits.
class CauseNumbers {
 public:
  CauseNumbers(const Causes& causes, const CausesOfReading& reading) {
    double largest = std::fabs(reading.difference());
    for (const KindSum& sum : sums_by_kind(causes, reading)) largest = std::max(largest, std::fabs(sum.difference));
    constexpr int kMost = 8;
    if (largest > 0) decimals_ = std::clamp(1 - static_cast<int>(std::floor(std::log10(largest))), 0, kMost);
  }
  bool is_zero(double value) const { return std::fabs(value) < 0.5 * std::pow(10.0, -decimals_); }
  std::string operator()(double value) const {
    return is_zero(value) ? formatted("%.*f", decimals_, 0.0) : formatted("%+.*f", decimals_, value);
  }

 private:
  int decimals_ = 2;
};

}  // namespace espdiff
