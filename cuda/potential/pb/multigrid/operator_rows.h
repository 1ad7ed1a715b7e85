// operator_rows.h: the rows of an operator's coefficients, from its arrays or unpacked plane by plane (CPU).
//
// Planes that were just unpacked stay in the cache. So a pass over a packed grid reads a sixteenth of what the arrays
// would have it read from memory.
#pragma once

#if !defined(ESPDIFF_BACKEND_CUDA)

#include <vector>

#include "cuda/potential/pb/multigrid/packed_operator.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Coefficients of the points of a row along x: [point] each.
struct OperatorRow {
  const float* ex;
  const float* ey;
  const float* ey_before;  ///< of the row before, y - 1
  const float* ez;
  const float* ez_below;        ///< of the row below, z - 1
  const float* diagonal;        ///< of the inner points
  const float* plain_diagonal;  ///< of those at plain ends
  float plain;                  ///< the dielectric of the faces there
  int first, last, end;         ///< the inner points between the plain ends, and the row's last point
};

/// Rows [first, last) of a plane, all of them inner ones.
struct RowRange {
  int first, last;
};
inline RowRange inner_rows(const GridSize& size) { return {1, size.ny - 1}; }

/// Whether the plain ends of rows are unpacked as well.
enum class PlainEnds { kUnpacked, kLeftOut };

/// Gives the rows of one operator, plane after plane. Not for several threads at once: each has its own.
class OperatorRows {
 public:
  /// @param of must outlive this object
  /// @param storage for unpacked planes; kept for the next one, so that each pass need not allocate
  OperatorRows(const GridOperator& of, Buffer<float>& storage, PlainEnds ends)
      : OperatorRows(of, storage, ends, inner_rows(of.size)) {}
  /// Of some of each plane's rows alone.
  OperatorRows(const GridOperator& of, Buffer<float>& storage, PlainEnds ends, RowRange rows);
  /// Makes the rows of an inner plane and of the three before it available.
  void hold(int k);
  /// One of the rows, of a plane that is held.
  OperatorRow at(int j, int k) const;

 private:
  enum Array { kX, kY, kZ, kDiagonal, kArrays };
  static constexpr int kPlanes = 4;
  MixedPoints mixed_of(std::size_t row) const;
  const float* plane_of(Array array, int k) const;
  float* unpacked(Array array, int k);
  const std::uint8_t* codes_of(std::size_t row, RowRange points);
  RowRange needed_faces(std::size_t row) const;  // of points
  void unpack_faces(int k);
  void unpack_diagonal(int k);

  const GridOperator& of_;
  Buffer<float>& storage_;
  RowRange rows_;
  const MixedPoints* mixed_ = nullptr;    ///< [row] points to unpack; null for all
  std::vector<float> plain_diagonal_[2];  ///< [point] of a row without ions and with them
  std::vector<std::uint8_t> codes_;       ///< [point] of one row
  int first_ = 0, last_ = -1;             ///< planes whose faces are unpacked
};

}  // namespace espdiff::ESPDIFF_BACKEND

#endif
