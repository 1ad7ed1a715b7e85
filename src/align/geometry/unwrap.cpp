// unwrap.cpp: makes parts of a molecule whole, then moves them together.
#include "align/geometry/unwrap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "align/geometry/superpose.h"
#include "base/error.h"

namespace espdiff {
namespace {

/// An atom farther than this from the previous one starts a new part; consecutive C-alpha atoms are 3.8 A apart.
constexpr double kLongestLink_A = 12;

/// Atoms first to last - 1.
struct Part {
  std::size_t first, last;

  std::size_t size() const { return last - first; }
};

Vec3d centre_of(const std::vector<Vec3d>& atoms, const Part& part) {
  Vec3d sum{};
  for (std::size_t i = part.first; i < part.last; ++i) sum += atoms[i];
  return (1.0 / static_cast<double>(part.size())) * sum;
}

std::vector<Part> join_neighbours(std::vector<Vec3d>& atoms, const std::array<Vec3d, 3>& edges) {
  std::vector<Part> parts = {{0, 1}};
  for (std::size_t i = 1; i < atoms.size(); ++i) {
    const Vec3d link = shortest_image(atoms[i] - atoms[i - 1], edges);
    if (dot(link, link) > kLongestLink_A * kLongestLink_A) {
      parts.push_back({i, i + 1});
      continue;
    }
    atoms[i] = atoms[i - 1] + link;
    parts.back().last = i + 1;
  }
  return parts;
}

/// The transform from the atoms to the reference, fitted to the largest part.
RigidTransform into_reference(const std::vector<Vec3d>& atoms, const std::vector<Vec3d>& reference, const Part& part) {
  if (part.size() >= 3) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = part.first; i < part.last; ++i) pairs.emplace_back(i, i);
    return superpose(atoms, reference, pairs).transform;
  }
  RigidTransform shift;
  shift.translation = centre_of(reference, part) - centre_of(atoms, part);
  return shift;
}

}  // namespace

Vec3d shortest_image(Vec3d v, const std::array<Vec3d, 3>& edges) {
  const double volume = dot(edges[0], cross(edges[1], edges[2]));
  const double parts[3] = {dot(v, cross(edges[1], edges[2])) / volume, dot(v, cross(edges[2], edges[0])) / volume,
                           dot(v, cross(edges[0], edges[1])) / volume};
  for (std::size_t axis = 0; axis < 3; ++axis) v = v - std::round(parts[axis]) * edges[axis];
  Vec3d best = v;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        const Vec3d image = v + static_cast<double>(i) * edges[0] + static_cast<double>(j) * edges[1] +
                            static_cast<double>(k) * edges[2];
        if (dot(image, image) < dot(best, best)) best = image;
      }
    }
  }
  return best;
}

std::vector<Vec3d> unwrapped(const std::vector<Vec3d>& atoms, const std::array<Vec3d, 3>& edges,
                             const std::vector<Vec3d>& reference) {
  if (!(std::fabs(dot(edges[0], cross(edges[1], edges[2]))) > 0))
    throw InputError("a molecule cannot be unwrapped in a cell without volume; correct the cell");
  if (!reference.empty() && reference.size() != atoms.size())
    throw InputError("a molecule of " + std::to_string(atoms.size()) + " atoms cannot be unwrapped like one of " +
                     std::to_string(reference.size()));
  std::vector<Vec3d> result = atoms;
  if (atoms.empty()) return result;
  std::vector<Part> parts = join_neighbours(result, edges);
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.size() > b.size(); });
  const RigidTransform to_reference =
      reference.empty() ? RigidTransform() : into_reference(result, reference, parts.front());
  const RigidTransform from_reference = inverse(to_reference);
  Vec3d placed = static_cast<double>(parts.front().size()) * centre_of(result, parts.front());
  std::size_t n_placed = parts.front().size();
  for (std::size_t p = 1; p < parts.size(); ++p) {
    const Part& part = parts[p];
    const Vec3d centre = centre_of(result, part);
    const Vec3d wanted = reference.empty() ? (1.0 / static_cast<double>(n_placed)) * placed
                                           : from_reference.apply(centre_of(reference, part));
    const Vec3d shift = wanted + shortest_image(centre - wanted, edges) - centre;
    for (std::size_t i = part.first; i < part.last; ++i) result[i] += shift;
    placed += static_cast<double>(part.size()) * (centre + shift);
    n_placed += part.size();
  }
  return result;
}

}  // namespace espdiff
