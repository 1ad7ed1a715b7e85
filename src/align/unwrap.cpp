// unwrap.cpp: makes parts of a molecule whole, then moves them together.
#include "align/unwrap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "align/superpose.h"
#include "base/error.h"

namespace espdiff {
namespace {

/// An atom farther than this from the previous one starts a new part; consecutive C-alpha atoms are 3.8 A apart.
constexpr double kLongestLink_A = 12;

/// Atoms first to last - 1.
struct Piece {
  std::size_t first, last;

  std::size_t size() const { return last - first; }
};

Vec3d centre_of(const std::vector<Vec3d>& atoms, const Piece& piece) {
  Vec3d sum{};
  for (std::size_t i = piece.first; i < piece.last; ++i) sum += atoms[i];
  return (1.0 / static_cast<double>(piece.size())) * sum;
}

std::vector<Piece> join_neighbours(std::vector<Vec3d>& atoms, const std::array<Vec3d, 3>& edges) {
  std::vector<Piece> pieces = {{0, 1}};
  for (std::size_t i = 1; i < atoms.size(); ++i) {
    const Vec3d link = shortest_image(atoms[i] - atoms[i - 1], edges);
    if (dot(link, link) > kLongestLink_A * kLongestLink_A) {
      pieces.push_back({i, i + 1});
      continue;
    }
    atoms[i] = atoms[i - 1] + link;
    pieces.back().last = i + 1;
  }
  return pieces;
}

/// The transform from the atoms to the reference, fitted to the largest part.
RigidTransform into_reference(const std::vector<Vec3d>& atoms, const std::vector<Vec3d>& reference,
                              const Piece& piece) {
  if (piece.size() >= 3) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = piece.first; i < piece.last; ++i) pairs.emplace_back(i, i);
    return superpose(atoms, reference, pairs).transform;
  }
  RigidTransform shift;
  shift.translation = centre_of(reference, piece) - centre_of(atoms, piece);
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
  std::vector<Piece> pieces = join_neighbours(result, edges);
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.size() > b.size(); });
  const RigidTransform to_reference =
      reference.empty() ? RigidTransform() : into_reference(result, reference, pieces.front());
  const RigidTransform from_reference = inverse(to_reference);
  Vec3d placed = static_cast<double>(pieces.front().size()) * centre_of(result, pieces.front());
  std::size_t n_placed = pieces.front().size();
  for (std::size_t p = 1; p < pieces.size(); ++p) {
    const Piece& piece = pieces[p];
    const Vec3d centre = centre_of(result, piece);
    const Vec3d wanted = reference.empty() ? (1.0 / static_cast<double>(n_placed)) * placed
                                           : from_reference.apply(centre_of(reference, piece));
    const Vec3d shift = wanted + shortest_image(centre - wanted, edges) - centre;
    for (std::size_t i = piece.first; i < piece.last; ++i) result[i] += shift;
    placed += static_cast<double>(piece.size()) * (centre + shift);
    n_placed += piece.size();
  }
  return result;
}

}  // namespace espdiff
