// random_charges.h: charges for timing Ewald sums.
#pragma once

#include <vector>

#include "engine/potential_stage.h"

namespace espdiff_bench {

struct RandomCharges {
  std::vector<espdiff::Vec3d> positions;  ///< Angstrom
  std::vector<float> charges;             ///< e, from -0.5 to 0.5
  espdiff::PmeCell cell;
};

espdiff::PmeCell cubic_cell(double edge_A);

/// Charges spread evenly in a cube around the origin, in random order, as in a water box; the same on every call.
RandomCharges random_charges(std::size_t n_atoms, double edge_A);

}  // namespace espdiff_bench
