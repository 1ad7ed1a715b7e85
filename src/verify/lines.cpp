// lines.cpp: recorded numbers beside recomputed ones.
#include "verify/lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace espdiff {
namespace {

/// Sums in single precision against sums in double precision.
constexpr double kRelative = 2e-4;

}  // namespace

void Lines::add(const std::string& pointer, double recomputed, double tolerance) {
  const double recorded = record_.number(pointer).value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::isnan(recorded) && !std::isfinite(recomputed)) return;
  result_.lines.push_back({pointer, recorded, recomputed, std::max(tolerance, kRelative * std::fabs(recorded))});
}
void Lines::add_sum(const std::string& pointer, double recomputed, double tolerance) {
  result_.lines.push_back({pointer + ", sum", record_.sum(pointer), recomputed, tolerance});
}
void Lines::add_deviation(const std::string& name, double largest, double tolerance) {
  result_.lines.push_back({name, 0, largest, tolerance});
}
void Lines::leave_out(const std::string& name, const std::string& why) {
  result_.not_recomputed.push_back(name + ": " + why);
}

}  // namespace espdiff
