// memory.cu: whether a grid fits into what memory is left.
#include "cuda/device/memory.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr double kMostPoints = 2.0e9;
constexpr double kNotWorthALook = 64e6;  // bytes

std::string gigabytes(double n_bytes) { return formatted("%.3g GB", std::max(0.0, n_bytes) / 1e9); }

}  // namespace

double coarsening_to_fit(double n_points, double bytes_per_point) {
  double most_points = kMostPoints;
  if (n_points * bytes_per_point > kNotWorthALook)
    most_points = std::min(most_points, std::max(1.0, available_bytes() / bytes_per_point));
  return n_points <= most_points ? 1.0 : std::cbrt(n_points / most_points);
}

std::string need_in_words(double n_points, double bytes_per_point) {
  const double needed = n_points * bytes_per_point, available = available_bytes();
  if (needed <= available) return "is above the limit of 2e9 points";
  return "needs " + gigabytes(needed) + " of memory, and " + gigabytes(available) + " are available";
}

void require_grid(double n_points, double bytes_per_point, const std::string& what) {
  const double coarser = coarsening_to_fit(n_points, bytes_per_point);
  if (coarser <= 1) return;
  throw MemoryError(what + " on a grid of " + formatted("%.4g", n_points) + " points " +
                    need_in_words(n_points, bytes_per_point) + "; a spacing " +
                    formatted("%.2f", std::ceil(100 * coarser) / 100) +
                    " times as large would fit, or select fewer atoms");
}

}  // namespace espdiff::ESPDIFF_BACKEND
