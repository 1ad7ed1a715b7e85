// packed_operator.cu: packs the coefficients of an operator, and unpacks them, row by row.
#include "cuda/potential/pb/multigrid/packed_operator.h"

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

/// Calls point(place in the row, code) for the points of a row, and before it face(4 * point + axis, value) for the
/// faces to be listed.
template <typename Point, typename Face>
ESPDIFF_INLINE void visit_row(const CoefficientArrays<const float>& in, std::size_t of_row, Point point, Face face) {
  for (std::size_t i = 0; i < in.row; ++i) {
    const std::size_t p = of_row * in.row + i;
    unsigned code = in.k[p] != 0.0F ? MixedPoints::kIonsBit : 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const float value = in.face(axis)[p];
      code |= (value == in.usual.solute ? 1U : 0U) << axis;
      if (value != in.usual_face(code, axis)) face(static_cast<std::uint32_t>(4 * i + axis), value);
    }
    point(static_cast<std::uint32_t>(i), code);
  }
}

/// Words of the codes of a row's own mixed points.
ESPDIFF_INLINE std::uint32_t n_words(const MixedPoints& own) {
  if (own.first >= own.last) return 0;
  return (own.last - 1) / CodeWord::kPoints - own.first / CodeWord::kPoints + 1;
}

ESPDIFF_INLINE void read_row(const CoefficientArrays<float>& out, std::size_t of_row, const PackedView& packed) {
  const std::size_t first = of_row * out.row;
  for (std::size_t i = 0; i < out.row; ++i) {
    const unsigned code = packed.code_of(of_row, static_cast<std::uint32_t>(i));
    out.k[first + i] = (code & MixedPoints::kIonsBit) != 0 ? out.usual.ions : 0.0F;
    for (unsigned axis = 0; axis < 3; ++axis) out.face(axis)[first + i] = out.usual_face(code, axis);
  }
  for (std::uint32_t n = packed.first_face[of_row]; n < packed.first_face[of_row + 1]; ++n) {
    const ListedFace& face = packed.listed[n];
    out.face(face.axis())[first + face.point()] = face.dielectric;
  }
}

std::size_t n_rows(const GridSize& size) {
  return static_cast<std::size_t>(size.ny) * static_cast<std::size_t>(size.nz);
}

/// [row] see PackedView::mixed. A point's faces are its row's, and those of the row before and of that below.
Buffer<MixedPoints> mixed_points(const Buffer<MixedPoints>& of_rows, const GridSize& size) {
  const std::size_t rows = n_rows(size), ny = static_cast<std::size_t>(size.ny);
  const std::uint32_t n = static_cast<std::uint32_t>(size.nx), end = n - 1;
  Buffer<MixedPoints> among_others(rows);
  const MixedPoints* const own = raw(of_rows);
  MixedPoints* const mixed = raw(among_others);
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    mixed[r] = {1, end, 0};
    if (!(r % ny > 0 && r % ny < ny - 1 && r >= ny && r + ny < rows)) return;
    std::uint32_t first = n, last = 0;
    for (const std::size_t row : {r, r - 1, r - ny}) {
      if (!own[row].has_plain_ends()) return;
      first = own[row].first < first ? own[row].first : first;
      last = own[row].last > last ? own[row].last : last;
    }
    if (first < n) ++last;  // its face before is that of the last one
    constexpr std::uint32_t kVector = 16;
    first = first > end ? end : first <= kVector ? 1 : 1 + (first - 1) / kVector * kVector;
    last = last <= first ? first : first + (last - first + kVector - 1) / kVector * kVector;
    mixed[r] = {first, last < end ? last : end, own[r].code_of_ends};
  });
  return among_others;
}

}  // namespace

std::shared_ptr<const PackedOperator> PackedOperator::pack(const GridOperator& on_grid, const UsualCoefficients& usual,
                                                           std::size_t points_per_listed) {
  auto packed = std::make_shared<PackedOperator>();
  packed->size_ = on_grid.size;
  packed->usual_ = usual;
  const std::size_t rows = n_rows(on_grid.size);
  packed->own_.resize(rows);
  packed->first_word_.assign(rows + 1, 0);
  packed->first_face_.assign(rows + 1, 0);
  MixedPoints* const own = raw(packed->own_);
  std::uint32_t* const first_word = raw(packed->first_word_);
  std::uint32_t* const first_face = raw(packed->first_face_);
  const CoefficientArrays<const float> all{raw(on_grid.ex),       raw(on_grid.ey), raw(on_grid.ez),
                                           raw(on_grid.diagonal), usual,           on_grid.size.row()};
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    const std::uint32_t n = static_cast<std::uint32_t>(all.row);
    MixedPoints mixed{n, 0, 0};
    std::uint32_t n_faces = 0;
    bool is_listed = false;
    visit_row(
        all, r,
        [&](std::uint32_t i, unsigned code) {
          if (i == 0) mixed.code_of_ends = code;
          if (is_listed || code != mixed.code_of_ends) {
            mixed.first = mixed.last == 0 ? i : mixed.first;
            mixed.last = i + 1;
          }
          is_listed = false;
        },
        [&](std::uint32_t, float) {
          ++n_faces;
          is_listed = true;
        });
    own[r] = mixed;
    first_word[r] = n_words(mixed);
    first_face[r] = n_faces;
  });
  const std::uint32_t words_of_all = exclusive_scan_in_place(packed->first_word_),
                      n_listed = exclusive_scan_in_place(packed->first_face_);
  if (std::size_t{n_listed} * points_per_listed > on_grid.size.points()) return nullptr;
  packed->words_.assign(words_of_all, CodeWord{0});
  packed->listed_.resize(n_listed);
  CodeWord* const words = raw(packed->words_);
  ListedFace* const listed = raw(packed->listed_);
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    const MixedPoints mixed = own[r];
    const std::uint32_t n_of_row = n_words(mixed);
    CodeWord* const of_row = words + first_word[r];
    ListedFace* next_face = listed + first_face[r];
    visit_row(
        all, r,
        [&](std::uint32_t i, unsigned code) {
          // Of the points beside the mixed ones too: words are unpacked as a whole.
          const std::uint32_t word = i / CodeWord::kPoints - mixed.first / CodeWord::kPoints;  // wraps before the first
          if (word < n_of_row) of_row[word].codes |= std::uint64_t{code} << CodeWord::shift_of(i);
        },
        [&](std::uint32_t place, float value) {
          *next_face++ = {place, value};
        });
  });
  packed->mixed_ = mixed_points(packed->own_, packed->size_);
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
