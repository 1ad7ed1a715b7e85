// packed_operator.h: the coefficients of a Poisson-Boltzmann operator in about half a byte a point: what the arrays of
// GridOperator hold in sixteen.
//
// Nearly all faces have the solute's dielectric or the solvent's, and k is that of ions or zero. A point's code says
// which for its three faces and k, and a row has runs of points of one code; other values, of faces that the boundary
// cuts, are listed. Nothing is rounded. The CPU's sweeps read packed rows (operator_rows.h), so that a solution holds
// no arrays of coefficients, and readings of its potential need not make them again.
#pragma once

#include <cstdint>
#include <memory>

#include "cuda/potential/pb/multigrid/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The two values that most faces have, and the two of k.
struct UsualCoefficients {
  float solute = 0, solvent = 0;  ///< dielectric
  float ions = 0;                 ///< k where ions can be; 0 elsewhere
};

/// A face of a row of points that has another value than those.
struct ListedFace {
  std::uint32_t place;  ///< four times the point's place in the row, plus the axis
  float dielectric;

  ESPDIFF_INLINE std::uint32_t point() const { return place / 4; }
  ESPDIFF_INLINE std::uint32_t axis() const { return place % 4; }
};

/// Points of a row that have one code: a bit for each face (1 solute, 0 solvent), one for k.
struct CodeRun {
  std::uint8_t code, n_points;

  static constexpr unsigned kMostPoints = 255;
};

/// Whether the six faces of all points of a row have the solvent's dielectric, and whether ions are all along it or
/// nowhere. More than half of the rows around a protein are plain.
enum PlainRow : std::uint8_t { kNotPlain, kWithoutIons, kWithIons };

/// Packed coefficients, for kernels. A row of points along x is numbered y + ny z.
struct PackedView {
  const std::uint32_t* first_run;   ///< [row + 1] of `runs`
  const CodeRun* runs;              ///< in the order of points
  const std::uint32_t* first_face;  ///< [row + 1] of `listed`
  const ListedFace* listed;         ///< in the order of points, then of x, y, z
  const std::uint8_t* plain;        ///< [row] see PlainRow
  UsualCoefficients usual;

  static constexpr unsigned kIonsBit = 8;
};

class PackedOperator {
 public:
  /// @param on_grid of fill_pb_operator(); its diagonal holds k alone
  /// @param points_per_listed more than one in so many would not pay: of eight, a byte a point
  /// @returns null where so many faces have other values, as of a smooth dielectric, that packing does not pay
  static std::shared_ptr<const PackedOperator> pack(const GridOperator& on_grid, const UsualCoefficients& usual,
                                                    std::size_t points_per_listed = 8);
  /// Fills in the coefficients, bit by bit those that were packed; the diagonal holds k alone.
  void unpack(GridOperator& on_grid) const;
  PackedView view() const { return {raw(first_run_), raw(runs_), raw(first_face_), raw(listed_), raw(plain_), usual_}; }

 private:
  GridSize size_;
  UsualCoefficients usual_;
  Buffer<std::uint32_t> first_run_, first_face_;
  Buffer<CodeRun> runs_;
  Buffer<ListedFace> listed_;
  Buffer<std::uint8_t> plain_;
};

}  // namespace espdiff::ESPDIFF_BACKEND
