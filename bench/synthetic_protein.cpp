// synthetic_protein.cpp: atoms by random sequential addition into a wavy ball, and smooth displacements.
#include "synthetic_protein.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>

namespace espdiff_bench {
namespace {

using espdiff::Vec3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kAtomsPerA3 = 0.1;
constexpr double kMinDistance_A = 1.6;

/// Uniform numbers whose bits do not depend on the standard library (its distributions do).
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }
  /// A direction, uniform over the sphere.
  Vec3d direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 generator_;
};

/// One wave over the unit sphere.
struct Wave {
  Vec3d wave_vector;
  double phase = 0, amplitude = 0;
  double at(Vec3d u) const { return amplitude * std::cos(dot(wave_vector, u) + phase); }
};

/// The outline: radius(u) = size * (1 + sum of waves), with `size` chosen for the volume of the atoms.
class Outline {
 public:
  Outline(double volume_A3, Random& random) {
    const double ball_radius = std::cbrt(volume_A3 * 3 / (4 * kPi));
    add_waves(6, 2.5, 0.12, random);
    add_waves(24, 2 * kPi * ball_radius / 10, 1.5 / ball_radius, random);
    size_ = std::cbrt(volume_A3 / unit_volume());
  }

  double radius(Vec3d u) const {
    double factor = 1;
    for (const Wave& wave : waves_) factor += wave.at(u);
    return size_ * std::max(factor, 0.2);
  }
  double largest_radius() const {
    double factor = 1;
    for (const Wave& wave : waves_) factor += wave.amplitude;
    return size_ * factor;
  }

 private:
  /// Waves of one length whose sum has the given root mean square.
  void add_waves(int n, double wave_number, double rms, Random& random) {
    for (int i = 0; i < n; ++i) {
      waves_.push_back({wave_number * random.direction(), random.uniform(0, 2 * kPi), rms * std::sqrt(2.0 / n)});
    }
  }
  /// Volume for size 1, by summing over a spiral of directions.
  double unit_volume() const {
    constexpr int kDirections = 20000;
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z),
                   angle = i * kPi * (3 - std::sqrt(5.0));
      const double radius_1 = radius({r * std::cos(angle), r * std::sin(angle), z});
      sum += radius_1 * radius_1 * radius_1;
    }
    return 4 * kPi / 3 * sum / kDirections;
  }

  std::vector<Wave> waves_;
  double size_ = 1;
};

/// Finds atoms nearer than kMinDistance_A, by cells of that size.
class Neighbours {
 public:
  bool free(Vec3d p) const {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find(key(p, dx, dy, dz));
          if (cell == cells_.end()) continue;
          for (const Vec3d& q : cell->second) {
            if (dot(p - q, p - q) < kMinDistance_A * kMinDistance_A) return false;
          }
        }
      }
    }
    return true;
  }
  void add(Vec3d p) { cells_[key(p, 0, 0, 0)].push_back(p); }

 private:
  static std::uint64_t key(Vec3d p, int dx, int dy, int dz) {
    const auto cell = [](double x, int d) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / kMinDistance_A)) + d + (1 << 20));
    };
    return cell(p.x, dx) << 42 | cell(p.y, dy) << 21 | cell(p.z, dz);
  }
  std::unordered_map<std::uint64_t, std::vector<Vec3d>> cells_;
};

void add_atom(espdiff::Molecule& molecule, Vec3d position, Random& random) {
  struct Kind {
    const char* element;
    float radius;
    double up_to;
  };
  constexpr Kind kKinds[] = {{"H", 1.2F, 0.5}, {"C", 1.7F, 0.82}, {"N", 1.55F, 0.91}, {"O", 1.52F, 2.0}};
  const double choice = random.uniform(0, 1);
  const Kind& kind =
      *std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return choice < k.up_to; });
  constexpr std::size_t kResidueAtoms = 16;
  const std::size_t index = molecule.size();
  if (index % kResidueAtoms == 0) {
    molecule.residues.push_back({"ALA", "A", static_cast<std::int32_t>(molecule.residues.size() + 1), ' '});
  }
  espdiff::Atom atom;
  atom.name = kind.element + std::to_string(index % kResidueAtoms);
  atom.element = kind.element;
  atom.residue = static_cast<std::int32_t>(molecule.residues.size() - 1);
  molecule.atoms.push_back(atom);
  molecule.positions.push_back(position);
  molecule.radii.push_back(kind.radius);
  molecule.charges.push_back(random.uniform(0, 1) < 0.5 ? -0.3F : 0.3F);
}

}  // namespace

espdiff::Molecule synthetic_protein(std::size_t n_atoms, std::uint64_t seed) {
  Random random(seed);
  const Outline outline(static_cast<double>(n_atoms) / kAtomsPerA3, random);
  const double box = outline.largest_radius();
  Neighbours neighbours;
  espdiff::Molecule molecule;
  molecule.name = "synthetic protein of " + std::to_string(n_atoms) + " atoms";
  molecule.radii_origin = espdiff::ValueOrigin::kElement;
  while (molecule.size() < n_atoms) {
    const Vec3d p{random.uniform(-box, box), random.uniform(-box, box), random.uniform(-box, box)};
    const double r = norm(p);
    if (r == 0 || r > outline.radius((1 / r) * p) || !neighbours.free(p)) continue;
    neighbours.add(p);
    add_atom(molecule, p, random);
  }
  return molecule;
}

espdiff::Molecule displaced_smoothly(const espdiff::Molecule& molecule, double rms_A, std::uint64_t seed) {
  Random random(seed);
  struct VectorWave {
    Vec3d wave_vector, direction;
    double phase;
  };
  std::vector<VectorWave> waves;
  for (int i = 0; i < 24; ++i) {
    const double wave_number = 2 * kPi / random.uniform(20, 60);
    const Vec3d wave_vector = wave_number * random.direction();
    const Vec3d direction = random.direction();
    waves.push_back({wave_vector, direction, random.uniform(0, 2 * kPi)});
  }
  std::vector<Vec3d> shifts;
  double sum = 0;
  for (const Vec3d& p : molecule.positions) {
    Vec3d shift{};
    for (const VectorWave& wave : waves) shift += std::cos(dot(wave.wave_vector, p) + wave.phase) * wave.direction;
    sum += dot(shift, shift);
    shifts.push_back(shift);
  }
  const double scale = rms_A / std::sqrt(sum / static_cast<double>(shifts.size()));
  espdiff::Molecule copy = molecule;
  copy.name += ", displaced";
  for (std::size_t i = 0; i < shifts.size(); ++i) copy.positions[i] += scale * shifts[i];
  return copy;
}

espdiff::Grid smooth_map(const espdiff::Molecule& molecule, int n) {
  Vec3d lower = molecule.positions.front(), upper = lower;
  for (const Vec3d& p : molecule.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], p[axis]);
      upper[axis] = std::max(upper[axis], p[axis]);
    }
  }
  constexpr double kMargin_A = 6;
  espdiff::Grid map;
  map.name = "smooth wave";
  map.unit = espdiff::PotentialUnit::kKtPerE;
  map.lattice.size = {n, n, n};
  map.lattice.origin = lower - Vec3d{kMargin_A, kMargin_A, kMargin_A};
  for (int axis = 0; axis < 3; ++axis) {
    map.lattice.step[static_cast<std::size_t>(axis)][axis] = (upper[axis] - lower[axis] + 2 * kMargin_A) / (n - 1);
  }
  map.values.reserve(map.lattice.n_points());
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        map.values.push_back(static_cast<float>(std::sin(0.17 * i) + std::cos(0.13 * j + 0.11 * k)));
    }
  }
  return map;
}

}  // namespace espdiff_bench
