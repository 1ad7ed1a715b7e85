// packed_operator.cu: packs the coefficients of an operator, and unpacks them, row by row.
#include "cuda/potential/pb/packed_operator.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The coefficients of all points, for kernels.
template <typename Value>
struct CoefficientArrays {
  Value *ex, *ey, *ez, *k;
  UsualCoefficients usual;
  std::size_t row;

  ESPDIFF_INLINE Value* face(unsigned axis) const { return axis == 0 ? ex : axis == 1 ? ey : ez; }
  ESPDIFF_INLINE float usual_face(unsigned code, unsigned axis) const {
    return (code >> axis & 1U) != 0 ? usual.solute : usual.solvent;
  }
};

/// Writes a row's codes. @returns how many of its faces are listed
ESPDIFF_INLINE std::uint32_t write_codes(const CoefficientArrays<const float>& in, std::size_t of_row,
                                         std::uint8_t* codes) {
  std::uint32_t n_listed = 0;
  for (std::size_t p = of_row * in.row; p < (of_row + 1) * in.row; ++p) {
    unsigned code = in.k[p] != 0.0F ? PackedView::kIonsBit : 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      code |= (in.face(axis)[p] == in.usual.solute ? 1U : 0U) << axis;
      n_listed += in.face(axis)[p] == in.usual_face(code, axis) ? 0 : 1;
    }
    codes[p] = static_cast<std::uint8_t>(code);
  }
  return n_listed;
}

ESPDIFF_INLINE void write_listed(const CoefficientArrays<const float>& in, std::size_t of_row,
                                 const std::uint8_t* codes, ListedFace* next) {
  for (std::size_t i = 0; i < in.row; ++i) {
    const std::size_t p = of_row * in.row + i;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const float value = in.face(axis)[p];
      if (value != in.usual_face(codes[p], axis)) *next++ = {static_cast<std::uint32_t>(4 * i + axis), value};
    }
  }
}

ESPDIFF_INLINE void read_row(const CoefficientArrays<float>& out, std::size_t of_row, const PackedView& packed) {
  const std::size_t first = of_row * out.row;
  for (std::size_t p = first; p < first + out.row; ++p) {
    const unsigned code = packed.codes[p];
    out.k[p] = (code & PackedView::kIonsBit) != 0 ? out.usual.ions : 0.0F;
    for (unsigned axis = 0; axis < 3; ++axis) out.face(axis)[p] = out.usual_face(code, axis);
  }
  for (std::uint32_t n = packed.first_of_row[of_row]; n < packed.first_of_row[of_row + 1]; ++n) {
    const ListedFace& face = packed.listed[n];
    out.face(face.axis())[first + face.point()] = face.dielectric;
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
  packed->first_of_row_.assign(n_rows(on_grid.size) + 1, 0);
  std::uint8_t* const codes = raw(packed->codes_);
  std::uint32_t* const first = raw(packed->first_of_row_);
  const CoefficientArrays<const float> all{raw(on_grid.ex),       raw(on_grid.ey), raw(on_grid.ez),
                                           raw(on_grid.diagonal), usual,           on_grid.size.row()};
  for_each_index(n_rows(on_grid.size), [=] ESPDIFF_HD(std::size_t r) { first[r] = write_codes(all, r, codes); });
  const std::uint32_t n_listed = exclusive_scan_in_place(packed->first_of_row_);
  constexpr std::size_t kPointsPerListed = 8;  // more would take as much memory as the codes
  if (std::size_t{n_listed} * kPointsPerListed > on_grid.size.points()) return nullptr;
  packed->listed_.resize(n_listed);
  ListedFace* const listed = raw(packed->listed_);
  for_each_index(n_rows(on_grid.size),
                 [=] ESPDIFF_HD(std::size_t r) { write_listed(all, r, codes, listed + first[r]); });
  return packed;
}

void PackedOperator::unpack(GridOperator& on_grid) const {
  on_grid.size = size_;
  for (Buffer<float>* buffer : {&on_grid.ex, &on_grid.ey, &on_grid.ez, &on_grid.diagonal})
    buffer->resize(size_.points());
  const CoefficientArrays<float> all{raw(on_grid.ex),       raw(on_grid.ey), raw(on_grid.ez),
                                     raw(on_grid.diagonal), usual_,          size_.row()};
  const PackedView packed = view();
  for_each_index(n_rows(size_), [=] ESPDIFF_HD(std::size_t r) { read_row(all, r, packed); });
}

}  // namespace espdiff::ESPDIFF_BACKEND
