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

/// The points from `first` to before `last` of a row of n points have other coefficients than those at its ends, which
/// have one code: a bit for each face (1 solute, 0 solvent), one for k.
struct MixedPoints {
  std::uint32_t first, last;
  std::uint32_t code_of_ends;

  static constexpr unsigned kIonsBit = 8;
  ESPDIFF_INLINE bool has_plain_ends() const { return (code_of_ends & ~kIonsBit) == 0; }
  ESPDIFF_INLINE unsigned has_ions() const { return (code_of_ends & kIonsBit) != 0 ? 1 : 0; }
};

/// The codes of sixteen points of a row, four bits each: a byte has point i's, and above it that of i + 8. Its first
/// point is a multiple of 16.
struct CodeWord {
  std::uint64_t codes;

  static constexpr std::uint32_t kPoints = 16;
  static constexpr std::uint64_t kLow = 0x0F0F0F0F0F0F0F0FULL;
  static ESPDIFF_INLINE unsigned shift_of(std::uint32_t point) { return point % 8 * 8 + point % 16 / 8 * 4; }
  ESPDIFF_INLINE unsigned of(std::uint32_t point) const {
    return static_cast<unsigned>(codes >> shift_of(point)) & 15U;
  }
};

/// Packed coefficients, for kernels. A row of points along x is numbered y + ny z.
struct PackedView {
  const MixedPoints* own;           ///< [row] by the row's own coefficients
  const std::uint32_t* first_word;  ///< [row + 1] of `words`, those of its own mixed points
  const CodeWord* words;
  const std::uint32_t* first_face;  ///< [row + 1] of `listed`
  const ListedFace* listed;         ///< in the order of points, then of x, y, z
  /// [row] All six faces of points that are not mixed have the solvent's dielectric. More than half of the rows around
  /// a protein have no mixed points, first = last = n - 1, and of the others about half of the points are not. Both
  /// ends but the last are whole vectors. Of rows of the grid's border all inner points.
  const MixedPoints* mixed;
  UsualCoefficients usual;

  ESPDIFF_INLINE unsigned code_of(std::size_t row, std::uint32_t point) const {
    const MixedPoints& of = own[row];
    if (point < of.first || point >= of.last) return of.code_of_ends;
    return words[first_word[row] + point / CodeWord::kPoints - of.first / CodeWord::kPoints].of(point);
  }
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
  PackedView view() const {
    return {raw(own_), raw(first_word_), raw(words_), raw(first_face_), raw(listed_), raw(mixed_), usual_};
  }

 private:
  GridSize size_;
  UsualCoefficients usual_;
  Buffer<std::uint32_t> first_word_, first_face_;
  Buffer<CodeWord> words_;
  Buffer<ListedFace> listed_;
  Buffer<MixedPoints> own_, mixed_;
};

}  // namespace espdiff::ESPDIFF_BACKEND
