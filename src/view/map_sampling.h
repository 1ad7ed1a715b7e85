// map_sampling.h: where a point lies in a map, and the map's value there: what the shaders do, on the host.
#pragma once

#include "base/types.h"

namespace espdiff {

/// From positions in a map's frame (Angstrom) to places in grid points; whole numbers are grid points.
class LatticeIndex {
 public:
  /// @throws InputError when the axes lie in a plane. @param name of the map, for the message
  LatticeIndex(const Lattice& lattice, const std::string& name);

  Vec3d operator()(Vec3d position) const {
    const Vec3d offset = position - origin_;
    return {dot(rows_[0], offset), dot(rows_[1], offset), dot(rows_[2], offset)};
  }

 private:
  Vec3d origin_;
  Vec3d rows_[3];  ///< of the inverse of the matrix whose columns are the steps
};

/// Trilinear value of a map at a place in grid points; NaN outside, where `outside` is taken with the slack of the
/// shaders.
float sample_at(const Grid& map, Vec3d index);

}  // namespace espdiff
