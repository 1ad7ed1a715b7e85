// far_charges.cu: the nodes around each atom, and sums to and from them in the order of the atoms.
#include "cuda/potential/far_charges.h"

#include <algorithm>
#include <cmath>

#include "cuda/potential/cubic_weights.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Nodes are worth it from so many times fewer on.
constexpr std::size_t kFewer = 2;

}  // namespace

template <typename Visit>
void FarCharges::visit(const Spread& atom, const Visit& visit) const {
  for (std::size_t k = 0; k < kWide; ++k) {
    for (std::size_t j = 0; j < kWide; ++j) {
      const double of_row = atom.weight[2][k] * atom.weight[1][j];
      const std::size_t first = atom.first + k * plane_ + j * row_;
      for (std::size_t i = 0; i < kWide; ++i) visit(first + i, of_row * atom.weight[0][i]);
    }
  }
}

FarCharges::FarCharges(const std::vector<PbAtom>& atoms, double spacing_A) {
  for (const PbAtom& atom : atoms) places_.push_back(static_cast<Vec3f>(atom.position));
  if (atoms.empty() || !(spacing_A > 0)) return;
  double low[3], first[3];
  std::size_t n[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto before = [axis](const PbAtom& a, const PbAtom& b) { return a.position[axis] < b.position[axis]; };
    const auto ends = std::minmax_element(atoms.begin(), atoms.end(), before);
    low[axis] = std::floor(ends.first->position[axis] / spacing_A);
    first[axis] = low[axis] - 1;
    n[axis] = static_cast<std::size_t>(std::floor(ends.second->position[axis] / spacing_A) - low[axis]) + kWide;
  }
  row_ = n[0];
  plane_ = n[0] * n[1];
  for (const PbAtom& atom : atoms) {
    Spread spread{};
    const std::size_t strides[3] = {1, row_, plane_};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = atom.position[axis] / spacing_A, cell = std::floor(place);
      cubic_weights(place - cell, spread.weight[axis]);
      spread.first += strides[axis] * static_cast<std::size_t>(cell - low[axis]);
    }
    spreads_.push_back(spread);
  }
  place_.assign(plane_ * n[2], -1);
  for (const Spread& spread : spreads_) visit(spread, [&](std::size_t node, double) { place_[node] = 0; });
  std::vector<Vec3f> nodes;
  for (std::size_t node = 0; node < place_.size(); ++node) {
    if (place_[node] < 0) continue;
    place_[node] = static_cast<std::int32_t>(nodes.size());
    const std::size_t index[3] = {node % row_, node / row_ % n[1], node / plane_};
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = spacing_A * (first[axis] + static_cast<double>(index[axis]));
    nodes.push_back(static_cast<Vec3f>(p));
  }
  if (kFewer * nodes.size() > atoms.size()) {
    spreads_.clear();
    return;
  }
  places_ = std::move(nodes);
}

std::vector<float> FarCharges::spread(const std::vector<double>& strengths) const {
  if (spreads_.empty()) return std::vector<float>(strengths.begin(), strengths.end());
  std::vector<double> sums(places_.size(), 0);
  for (std::size_t i = 0; i < strengths.size(); ++i)
    visit(spreads_[i], [&](std::size_t node, double weight) {
      sums[static_cast<std::size_t>(place_[node])] += weight * strengths[i];
    });
  return std::vector<float>(sums.begin(), sums.end());
}

std::vector<double> FarCharges::gather(const std::vector<float>& values) const {
  if (spreads_.empty()) return std::vector<double>(values.begin(), values.end());
  std::vector<double> sums(spreads_.size(), 0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    visit(spreads_[i], [&](std::size_t node, double weight) {
      sums[i] += weight * static_cast<double>(values[static_cast<std::size_t>(place_[node])]);
    });
  return sums;
}

}  // namespace espdiff::ESPDIFF_BACKEND
