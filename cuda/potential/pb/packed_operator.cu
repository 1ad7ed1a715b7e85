// packed_operator.cu: packs the coefficients of an operator, and unpacks them, row by row.
#include "cuda/potential/pb/packed_operator.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr unsigned kListed = 2, kFaceMask = 3, kIonsBit = 64;

/// The codes and the coefficients of all points, for kernels.
template <typename Code, typename Value>
struct PackedView {
  Code* codes;
  Value *ex, *ey, *ez, *k;
  UsualCoefficients usual;
  std::size_t row;

  ESPDIFF_INLINE Value* face(int axis) const { return axis == 0 ? ex : axis == 1 ? ey : ez; }
};

/// Writes a row's codes. @returns how many of its faces are listed
ESPDIFF_INLINE std::uint32_t write_codes(const PackedView<std::uint8_t, const float>& in, std::size_t of_row) {
  std::uint32_t n_listed = 0;
  for (std::size_t p = of_row * in.row; p < (of_row + 1) * in.row; ++p) {
    unsigned code = in.k[p] != 0.0F ? kIonsBit : 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float value = in.face(axis)[p];
      const unsigned kind = value == in.usual.solvent ? 0U : value == in.usual.solute ? 1U : kListed;
      code |= kind << (2 * static_cast<unsigned>(axis));
      n_listed += kind / kListed;
    }
    in.codes[p] = static_cast<std::uint8_t>(code);
  }
  return n_listed;
}

ESPDIFF_INLINE void write_listed(const PackedView<const std::uint8_t, const float>& in, std::size_t of_row,
                                 float* next) {
  for (std::size_t p = of_row * in.row; p < (of_row + 1) * in.row; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((in.codes[p] >> (2 * static_cast<unsigned>(axis)) & kFaceMask) == kListed) *next++ = in.face(axis)[p];
    }
  }
}

ESPDIFF_INLINE void read_row(const PackedView<const std::uint8_t, float>& out, std::size_t of_row, const float* next) {
  const float of[kListed] = {out.usual.solvent, out.usual.solute};
  for (std::size_t p = of_row * out.row; p < (of_row + 1) * out.row; ++p) {
    const unsigned code = out.codes[p];
    out.k[p] = (code & kIonsBit) != 0 ? out.usual.ions : 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned kind = code >> (2 * static_cast<unsigned>(axis)) & kFaceMask;
      out.face(axis)[p] = kind == kListed ? *next++ : of[kind];
    }
  }
}

std::size_t n_rows(const GridSize& size) {
  return static_cast<std::size_t>(size.ny) * static_cast<std::size_t>(size.nz);
}

}  // namespace

std::shared_ptr<const PackedOperator> PackedOperator::pack(const GridOperator& on_grid,
                                                           const UsualCoefficients& usual) {
  auto packed = std::make_shared<PackedOperator>();
  packed->size_ = on_grid.size;
  packed->usual_ = usual;
  packed->codes_.resize(on_grid.size.points());
  packed->first_of_row_.resize(n_rows(on_grid.size));
  const float* const ex = raw(on_grid.ex);
  const float* const ey = raw(on_grid.ey);
  const float* const ez = raw(on_grid.ez);
  const float* const k = raw(on_grid.diagonal);
  std::uint8_t* const codes = raw(packed->codes_);
  std::uint32_t* const first = raw(packed->first_of_row_);
  const std::size_t row = on_grid.size.row();
  const PackedView<std::uint8_t, const float> all{codes, ex, ey, ez, k, usual, row};
  for_each_index(n_rows(on_grid.size), [=] ESPDIFF_HD(std::size_t r) { first[r] = write_codes(all, r); });
  const std::uint32_t n_listed = exclusive_scan_in_place(packed->first_of_row_);
  constexpr std::size_t kPointsPerListed = 4;  // more would take as much memory as the codes
  if (std::size_t{n_listed} * kPointsPerListed > on_grid.size.points()) return nullptr;
  packed->listed_.resize(n_listed);
  float* const listed = raw(packed->listed_);
  const PackedView<const std::uint8_t, const float> coded{codes, ex, ey, ez, k, usual, row};
  for_each_index(n_rows(on_grid.size), [=] ESPDIFF_HD(std::size_t r) { write_listed(coded, r, listed + first[r]); });
  return packed;
}

void PackedOperator::unpack(GridOperator& on_grid) const {
  on_grid.size = size_;
  for (Buffer<float>* buffer : {&on_grid.ex, &on_grid.ey, &on_grid.ez, &on_grid.diagonal})
    buffer->resize(size_.points());
  const PackedView<const std::uint8_t, float> all{
      raw(codes_), raw(on_grid.ex), raw(on_grid.ey), raw(on_grid.ez), raw(on_grid.diagonal), usual_, size_.row()};
  const float* const listed = raw(listed_);
  const std::uint32_t* const first = raw(first_of_row_);
  for_each_index(n_rows(size_), [=] ESPDIFF_HD(std::size_t r) { read_row(all, r, listed + first[r]); });
}

}  // namespace espdiff::ESPDIFF_BACKEND
