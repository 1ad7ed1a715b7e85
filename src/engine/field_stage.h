// field_stage.h: values of atoms that are carried to a surface.
#pragma once

#include <vector>

#include "base/vector.h"

namespace espdiff {

/// How the values of atoms make a value at a point.
enum class AtomWeight {
  /// sum g v / sum g with g = exp(-d^2 / (2 s^2)), the atom's share of the density: continuous, and never beyond the
  /// values of the atoms around.
  kDensityMean,
  /// sum v exp(-d / A) over the atoms within kDecayReach_A, the distance function of Fauchere, Quarendon and Kaetterer
  /// (J. Mol. Graph. 6, 203 (1988)): a potential that adds up.
  kDecaySum
};
constexpr double kDecayReach_A = 5;

/// Atoms with a value each, in the common frame.
struct AtomValues {
  std::vector<Vec3d> positions;  ///< [atom] Angstrom
  std::vector<float> widths;     ///< [atom] standard deviation s, Angstrom; atoms of width 0 are ignored
  std::vector<float> values;     ///< [atom] NaN where the atom has none
  AtomWeight weight = AtomWeight::kDensityMean;
};

}  // namespace espdiff
