// packed_operator.h: the coefficients of a Poisson-Boltzmann operator in a byte a point, so that readings of its
// potential need not make them again.
//
// Nearly all faces have the solute's dielectric or the solvent's, and k is that of ions or zero. A point's byte says
// which for its three faces and k; other values, of faces that the boundary cuts, are listed. Nothing is rounded.
#pragma once

#include <cstdint>
#include <memory>

#include "cuda/potential/pb/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The two values that most faces have, and the two of k.
struct UsualCoefficients {
  float solute = 0, solvent = 0;  ///< dielectric
  float ions = 0;                 ///< k where ions can be; 0 elsewhere
};

class PackedOperator {
 public:
  /// @param on_grid of fill_pb_operator(); its diagonal holds k alone
  /// @returns null where so many faces have other values, as of a smooth dielectric, that packing does not pay
  static std::shared_ptr<const PackedOperator> pack(const GridOperator& on_grid, const UsualCoefficients& usual);
  /// Fills in the coefficients, bit by bit those that were packed; the diagonal holds k alone.
  void unpack(GridOperator& on_grid) const;

 private:
  GridSize size_;
  UsualCoefficients usual_;
  Buffer<std::uint8_t> codes_;          ///< [point] two bits for each face (0 solvent, 1 solute, 2 listed), one for k
  Buffer<std::uint32_t> first_of_row_;  ///< [row] of `listed_`
  Buffer<float> listed_;                ///< in the order of points, then of x, y, z
};

}  // namespace espdiff::ESPDIFF_BACKEND
