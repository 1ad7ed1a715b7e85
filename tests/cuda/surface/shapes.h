// shapes.h: made inputs of the engine's tests: atoms, spheres, proteins.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "base/types.h"
#include "support/random.h"

namespace espdiff_test {

using espdiff::Mesh;

/// Of the density, at the surfaces of most tests.
constexpr float kIsovalue = 0.5F;

/// Atoms as upload_atoms() takes them.
struct AtomSet {
  std::vector<Vec3d> positions;
  std::vector<float> widths;
  std::vector<std::int32_t> residues;

  std::size_t size() const { return positions.size(); }
  void add(Vec3d position, double width, std::int32_t residue = 0) {
    positions.push_back(position);
    widths.push_back(static_cast<float>(width));
    residues.push_back(residue);
  }
};

inline AtomSet one_gaussian(Vec3d centre, double width) {
  AtomSet atoms;
  atoms.add(centre, width);
  return atoms;
}

/// A ball of atoms as dense as a protein (about 0.1 per A^3), no two nearer than 1 A, ten to a residue.
inline AtomSet random_cloud(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  AtomSet atoms;
  const double radius = std::cbrt(static_cast<double>(n) / 0.1 * 3 / (4 * kPi));
  while (atoms.size() < n) {
    const Vec3d p = random.in_box(radius);
    bool fits = norm(p) < radius;
    for (const Vec3d& q : atoms.positions) fits = fits && norm(p - q) > 1.0;
    if (fits) atoms.add(p, random.uniform(1.0, 2.0), static_cast<std::int32_t>(atoms.size() / 10));
  }
  return atoms;
}

/// A hollow ball: atoms all over a sphere, so that the density has one cavity around `centre`.
inline AtomSet hollow_ball(Vec3d centre, double radius, std::size_t n) {
  AtomSet atoms;
  for (std::size_t i = 0; i < n; ++i) {  // a spiral of equal steps in height, Fibonacci's angle apart
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n),
                 angle = 2.39996323 * static_cast<double>(i);
    const double r = std::sqrt(1 - z * z);
    atoms.add(centre + radius * Vec3d{r * std::cos(angle), r * std::sin(angle), z}, 1.5);
  }
  return atoms;
}

/// A molecule's atoms with the centroid at the origin, as in a comparison.
inline AtomSet atoms_of(const espdiff::Molecule& molecule) {
  AtomSet atoms;
  Vec3d centre{};
  for (const Vec3d& p : molecule.positions) centre += (1.0 / static_cast<double>(molecule.size())) * p;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    atoms.add(molecule.positions[i] - centre, static_cast<double>(molecule.radii[i]), molecule.atoms[i].residue);
  }
  return atoms;
}

/// A sphere of 20 * 4^levels triangles.
inline Mesh icosphere(int levels, double radius, Vec3d centre = {}) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3d> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  Mesh mesh;
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (; levels > 0; --levels) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] = middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (is_new) {
        const Vec3d sum = (1 / norm(points[a])) * points[a] + (1 / norm(points[b])) * points[b];
        points.push_back(sum);
      }
      return entry->second;
    };
    std::vector<espdiff::Triangle> finer;
    for (const auto& t : mesh.triangles) {
      const std::uint32_t a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    mesh.triangles = finer;
  }
  for (const Vec3d& p : points) mesh.positions.push_back(static_cast<Vec3f>(centre + (radius / norm(p)) * p));
  return mesh;
}

/// The mesh with every vertex moved by `move`.
template <typename Move>
Mesh moved(Mesh mesh, Move move) {
  for (Vec3f& p : mesh.positions) p = static_cast<Vec3f>(move(static_cast<Vec3d>(p)));
  return mesh;
}

/// The mesh inside out.
inline Mesh turned(Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// One point of a lattice.
inline Vec3d lattice_point(const espdiff::Lattice& lattice, std::size_t index) {
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  return lattice.origin + static_cast<double>(index % nx) * lattice.step[0] +
         static_cast<double>(index / nx % ny) * lattice.step[1] +
         static_cast<double>(index / (nx * ny)) * lattice.step[2];
}

}  // namespace espdiff_test
