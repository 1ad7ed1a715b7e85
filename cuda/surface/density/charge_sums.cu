// charge_sums.cu: sorts point charges, those of a cell into bins, for the sums of charge_sums.h.
#include "cuda/surface/density/charge_sums.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A total order of charges that differ.
bool in_order(const PointCharge& a, const PointCharge& b) {
  if (a.place.x != b.place.x) return a.place.x < b.place.x;
  if (a.place.y != b.place.y) return a.place.y < b.place.y;
  if (a.place.z != b.place.z) return a.place.z < b.place.z;
  return a.charge < b.charge;
}

constexpr int kMostBins = 64;

/// Bins in one direction; more are never summed over (PmeSolver refuses them).
constexpr double kMostReach = 1e6;

/// Bins of a third of the range: spheres of it then fill a third of the bins that are visited.
int bins_along(double height_A, double range_A) {
  return std::clamp(static_cast<int>(3 * height_A / range_A), 1, kMostBins);
}

}  // namespace

ChargeSums::ChargeSums(const std::vector<Vec3d>& positions, const std::vector<float>& charges, double scale,
                       bool by_distance) {
  std::vector<PointCharge> kept;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (charges[i] != 0) kept.push_back({positions[i], scale * static_cast<double>(charges[i])});
  }
  std::sort(kept.begin(), kept.end(), in_order);
  charges_ = to_device(kept);
  shape_.n = kept.size();
  shape_.by_distance = by_distance;
}

ChargeSums::ChargeSums(std::vector<PointCharge> parts, const std::array<Vec3d, 3>& edges, double beta) {
  const double range = kDirectReach / beta, volume = dot(edges[0], cross(edges[1], edges[2]));
  shape_.beta = static_cast<float>(beta);
  shape_.range_square = range * range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double height = volume / norm(cross(edges[(axis + 1) % 3], edges[(axis + 2) % 3]));
    shape_.edges[axis] = edges[axis];
    shape_.bins[axis] = bins_along(height, range);
    shape_.reach[axis] = static_cast<int>(std::min(std::ceil(range * shape_.bins[axis] / height), kMostReach));
  }
  const auto bin_of = [this](const PointCharge& c) {
    int at[3];
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = std::min(static_cast<int>(c.place[axis] * shape_.bins[axis]), shape_.bins[axis] - 1);
    return static_cast<std::uint32_t>(at[0] + shape_.bins[0] * (at[1] + shape_.bins[1] * at[2]));
  };
  for (PointCharge& c : parts) {
    for (int axis = 0; axis < 3; ++axis) c.place[axis] = wrapped(c.place[axis], 1);
  }
  std::sort(parts.begin(), parts.end(), [&](const PointCharge& a, const PointCharge& b) {
    const std::uint32_t bin_a = bin_of(a), bin_b = bin_of(b);
    return bin_a != bin_b ? bin_a < bin_b : in_order(a, b);
  });
  std::vector<std::uint32_t> first(static_cast<std::size_t>(shape_.bins[0] * shape_.bins[1] * shape_.bins[2]) + 1, 0);
  for (const PointCharge& c : parts) ++first[bin_of(c) + 1];
  for (std::size_t bin = 1; bin < first.size(); ++bin) first[bin] += first[bin - 1];
  shape_.n = parts.size();
  charges_ = to_device(parts);
  first_ = to_device(first);
}

double ChargeSums::n_terms() const {
  double n_bins = 1, n_visited = 1;
  for (int axis = 0; axis < 3; ++axis) {
    n_bins *= shape_.bins[axis];
    n_visited *= 2.0 * shape_.reach[axis] + 1;
  }
  return n_visited * (1 + static_cast<double>(shape_.n) / n_bins);
}

ChargeSumsView ChargeSums::view() const {
  ChargeSumsView view = shape_;
  view.charges = raw(charges_);
  view.first = raw(first_);
  return view;
}

}  // namespace espdiff::ESPDIFF_BACKEND
