// shapes.h: inputs of the engine's tests: back ends, atoms, spheres, proteins, rigid motions.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/read_structure.h"
#include "support/test_data.h"

namespace espdiff_test {

using espdiff::Engine;
using espdiff::Mesh;
using espdiff::Vec3d;
using espdiff::Vec3f;

constexpr double kPi = 3.14159265358979323846;

/// One engine for each back end that can run here; prints once per program which cannot, and why.
/// @param n_threads of the CPU back end; 0 uses all
inline std::vector<std::unique_ptr<Engine>> back_ends(int n_threads = 0) {
  std::vector<std::unique_ptr<Engine>> engines;
  engines.push_back(espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads));
  const espdiff::BackEndStatus cuda = espdiff::cuda_status();
  static bool announced = false;
  if (cuda.available) {
    engines.push_back(espdiff::select_engine(espdiff::DeviceChoice::kCuda, 0));
  } else if (!announced) {
    announced = true;
    MESSAGE("SKIPPED: cuda: ", cuda.description.plain());
  }
  return engines;
}

/// Reproducible random numbers: Knuth's MMIX generator, upper bits.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) { bits(); }

  std::uint32_t bits() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  /// In [low, high).
  double uniform(double low = 0, double high = 1) { return low + (high - low) * (bits() / 2147483648.0); }
  std::size_t below(std::size_t n) { return bits() % n; }
  Vec3d in_box(double half_side) {
    const double x = uniform(-half_side, half_side), y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v = in_box(1);
      const double length = norm(v);
      if (length > 0.1 && length < 1) return (1 / length) * v;
    }
  }

 private:
  std::uint64_t state_;
};

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

inline espdiff::AtomsPtr upload(Engine& engine, const AtomSet& atoms) {
  return engine.upload_atoms(atoms.positions, atoms.widths, atoms.residues);
}

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

inline AtomSet read_atoms(const std::string& path) { return atoms_of(espdiff::read_structure(path)); }

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

/// Rotation by `angle` about `axis` (a unit vector), then translation.
inline espdiff::RigidTransform rigid(Vec3d axis, double angle, Vec3d translation) {
  espdiff::RigidTransform t;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int column = 0; column < 3; ++column) {
    Vec3d e{};
    e[column] = 1;
    const Vec3d r = c * e + s * cross(axis, e) + ((1 - c) * dot(axis, e)) * axis;  // Rodrigues
    for (int row = 0; row < 3; ++row) t.rotation[3 * row + column] = r[row];
  }
  t.translation = translation;
  return t;
}

inline espdiff::RigidTransform random_rigid(Random& random, double shift) {
  const Vec3d axis = random.direction();
  const double angle = random.uniform(0.3, 3.0);
  return rigid(axis, angle, random.in_box(shift));
}

/// One point of a lattice.
inline Vec3d lattice_point(const espdiff::Lattice& lattice, std::size_t index) {
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  return lattice.origin + static_cast<double>(index % nx) * lattice.step[0] +
         static_cast<double>(index / nx % ny) * lattice.step[1] +
         static_cast<double>(index / (nx * ny)) * lattice.step[2];
}

}  // namespace espdiff_test
