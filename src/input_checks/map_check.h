// map_check.h: which potential of a molecule's charges a given map is, by regression near the surface.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"

namespace espdiff {

struct Surface;

/// The potentials that a map is compared with: in salt water (the Poisson-Boltzmann equation), of point charges in
/// vacuum (Coulomb's law, isolated or in the map's periodic cell), of smeared charges in vacuum (the smooth part of
/// Ewald's sum, beta 0.25/A, as PMEPot's, isolated or in that cell), and of point charges in a dielectric that grows
/// with the distance.
enum class ReferenceKind { kSolvent, kVacuum, kSmoothVacuum, kDistanceDependent };
constexpr std::size_t kReferenceKinds = 4;
/// "salt water", "vacuum", ...
const char* to_string(ReferenceKind kind);

/// Right maps reach 0.97 and more, those of other molecules and places less (bench/study_notes.md, *Errors in given
/// maps*).
constexpr double kLeastMapCorrelation = 0.93;
/// How far salt, dielectrics and boundaries take a slope in water from 1.
constexpr double kSolventFactor = 2.5;

/// map = slope * reference + constant, by least squares; NaN where there is no reference, or none was needed.
struct ReferenceFit {
  double slope = 0, correlation = 0;
};

/// How a given map compares with the potentials of its molecule's charges.
struct MapCheck {
  std::array<ReferenceFit, kReferenceKinds> fits{};
  ReferenceKind kind = ReferenceKind::kSolvent;  ///< of the largest correlation in size; its sign may be negative
  std::size_t n_points = 0;                      ///< that lie in the map
  std::size_t n_charges = 0;

  const ReferenceFit& best() const { return fits[static_cast<std::size_t>(kind)]; }
  bool is_vacuum() const { return kind == ReferenceKind::kVacuum || kind == ReferenceKind::kSmoothVacuum; }
};

/// "as in vacuum (smeared charges)": in a few words, for tables and legends.
std::string in_words(const MapCheck& check);

/// The reference potentials of one molecule at up to kCheckPoints points 2 A outside its surface, where potentials of
/// one kind agree whatever the fine print of the program that made them.
class MapReferences {
 public:
  static constexpr std::size_t kCheckPoints = 400;

  /// Solves the Poisson-Boltzmann equation on a lattice of 1.5 A to 1e-2, at the default salt and dielectrics, with the
  /// atoms' spheres for the boundary.
  /// @param to_common the molecule's own frame -> the surface's
  /// @param surface   of the molecule
  /// @throws MemoryError, DeviceError, Cancelled; a molecule that the equation refuses has no such reference
  MapReferences(Engine& engine, const Molecule& molecule, const RigidTransform& to_common, const Surface& surface,
                float isovalue, double temperature_K, const Progress& progress);

  /// @param map in the molecule's own frame
  /// @returns nothing where fewer than 20 atoms have charges, or fewer than half of the points lie in the map
  std::optional<MapCheck> check(const Grid& map) const;

 private:
  Engine& engine_;
  const Molecule& molecule_;
  double temperature_K_, coulomb_;
  std::size_t n_charges_ = 0;
  std::vector<Vec3d> points_;    // own frame
  std::vector<double> solvent_;  // [point] kT/e

  /// [point] kT/e: Coulomb's law, Ewald's direct part, and Coulomb's law with a dielectric of 1 / A * r.
  struct Sums {
    std::vector<double> vacuum, direct, screened;
  };
  /// Kept: the source's serve all targets.
  const Sums& sums_of_charges() const;
  std::vector<double> periodic(const Grid& map) const;

  mutable std::optional<Sums> sums_{};
};

/// A map's value at a point of its own frame: trilinear, axes may be skewed; NaN outside.
class MapSampler {
 public:
  explicit MapSampler(const Grid& map);
  double operator()(const Vec3d& point) const;

 private:
  const Grid& map_;
  std::array<Vec3d, 3> reciprocal_;
};

}  // namespace espdiff
