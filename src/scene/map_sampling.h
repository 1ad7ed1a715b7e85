// map_sampling.h: lookups of a map's value at a point, as in the shaders, on the host.
#pragma once

#include "base/types.h"

namespace espdiff {

/// Converts positions in a map's frame (Angstrom) to lattice coordinates; whole numbers are grid points.
class LatticeIndex {
 public:
  /// @throws InputError if the axes lie in a plane. @param name of the map, for the message
  LatticeIndex(const Lattice& lattice, const std::string& name);

  Vec3d operator()(Vec3d position) const {
    const Vec3d offset = position - origin_;
    return {dot(rows_[0], offset), dot(rows_[1], offset), dot(rows_[2], offset)};
  }

 private:
  Vec3d origin_;
  Vec3d rows_[3];  ///< of the inverse of the matrix with the steps as columns
};

/// Trilinear value of a map at lattice coordinates; NaN outside, with the shaders' tolerance at the border.
float sample_at(const Grid& map, Vec3d index);

}  // namespace espdiff
