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

/// The codes of the points of a word, a byte each, with a bit where one of the faces is to be listed.
struct CodedPoints {
  std::uint8_t codes[CodeWord::kPoints];

  static constexpr unsigned kListed = 16;

  /// @param p the first one's index; of `n` points, others get the code given
  ESPDIFF_INLINE CodedPoints(const CoefficientArrays<const float>& of, std::size_t p, std::uint32_t n,
                             unsigned beyond) {
    const CoefficientArrays<const float> in = of;  // a copy, which the codes cannot change
    if (n >= CodeWord::kPoints) {
      for (std::uint32_t i = 0; i < CodeWord::kPoints; ++i) codes[i] = code_at(in, p + i);
    } else {
      for (std::uint32_t i = 0; i < n; ++i) codes[i] = code_at(in, p + i);
      for (std::uint32_t i = n; i < CodeWord::kPoints; ++i) codes[i] = static_cast<std::uint8_t>(beyond);
    }
  }
  static ESPDIFF_INLINE std::uint8_t code_at(const CoefficientArrays<const float>& in, std::size_t p) {
    const float solute = in.usual.solute, solvent = in.usual.solvent, ex = in.ex[p], ey = in.ey[p], ez = in.ez[p];
    const int x = ex == solute, y = ey == solute, z = ez == solute, ions = in.k[p] != 0.0F;
    const int listed = ((ex != solvent) & ~x) | ((ey != solvent) & ~y) | ((ez != solvent) & ~z);
    return static_cast<std::uint8_t>(x | y << 1 | z << 2 | ions << 3 | listed << 4);
  }
  ESPDIFF_INLINE std::uint64_t half(unsigned h) const {
    std::uint64_t eight = 0;
    for (unsigned i = 0; i < 8; ++i) eight |= std::uint64_t{codes[8 * h + i]} << 8 * i;
    return eight;
  }
  ESPDIFF_INLINE bool are_all(unsigned code) const {
    const std::uint64_t eight = 0x0101010101010101ULL * code;
    return half(0) == eight && half(1) == eight;
  }
  ESPDIFF_INLINE CodeWord word() const { return {(half(0) & CodeWord::kLow) | (half(1) & CodeWord::kLow) << 4}; }
};

/// Calls listed(4 * point + axis, value) for the faces of a point that are to be listed.
template <typename Listed>
ESPDIFF_INLINE void visit_listed(const CoefficientArrays<const float>& in, std::size_t row, std::uint32_t point,
                                 const Listed& listed) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const float value = in.face(axis)[row * in.row + point];
    if (value != in.usual.solute && value != in.usual.solvent) listed(4 * point + axis, value);
  }
}

struct RowScan {
  MixedPoints own;
  std::uint32_t n_listed;
};
ESPDIFF_INLINE RowScan scan(const CoefficientArrays<const float>& in, std::size_t row) {
  const std::uint32_t n = static_cast<std::uint32_t>(in.row);
  const unsigned ends = CodedPoints(in, row * in.row, 1, 0).codes[0] & 15U;
  RowScan found{{n, 0, ends}, 0};
  for (std::uint32_t first = 0; first < n; first += CodeWord::kPoints) {
    const CodedPoints points(in, row * in.row + first, n - first, ends);
    if (points.are_all(ends)) continue;
    for (std::uint32_t i = 0; i < CodeWord::kPoints; ++i) {
      if (points.codes[i] == ends) continue;
      if (found.own.last == 0) found.own.first = first + i;
      found.own.last = first + i + 1;
      if ((points.codes[i] & CodedPoints::kListed) != 0)
        visit_listed(in, row, first + i, [&](std::uint32_t, float) { ++found.n_listed; });
    }
  }
  return found;
}

/// Writes the words of a row's own mixed points, and its listed faces.
ESPDIFF_INLINE void write(const CoefficientArrays<const float>& in, std::size_t row, const MixedPoints& own,
                          CodeWord* words, ListedFace* listed) {
  for (std::uint32_t first = own.first / CodeWord::kPoints * CodeWord::kPoints; first < own.last;
       first += CodeWord::kPoints) {
    const CodedPoints points(in, row * in.row + first, static_cast<std::uint32_t>(in.row) - first, 0);
    *words++ = points.word();
    for (std::uint32_t i = 0; i < CodeWord::kPoints; ++i) {
      if ((points.codes[i] & CodedPoints::kListed) == 0) continue;
      visit_listed(in, row, first + i, [&](std::uint32_t place, float value) { *listed++ = {place, value}; });
    }
  }
}

#if defined(__CUDACC__)
ESPDIFF_INLINE RowScan scan_row(const CoefficientArrays<const float>& in, std::size_t row) { return scan(in, row); }
ESPDIFF_INLINE void write_row(const CoefficientArrays<const float>& in, std::size_t row, const MixedPoints& own,
                              CodeWord* words, ListedFace* listed) {
  write(in, row, own, words, listed);
}
#else
ESPDIFF_MULTIVERSION RowScan scan_row(const CoefficientArrays<const float>& in, std::size_t row) {
  return scan(in, row);
}
ESPDIFF_MULTIVERSION void write_row(const CoefficientArrays<const float>& in, std::size_t row, const MixedPoints& own,
                                    CodeWord* words, ListedFace* listed) {
  write(in, row, own, words, listed);
}
#endif

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
    const RowScan found = scan_row(all, r);
    own[r] = found.own;
    first_word[r] = n_words(found.own);
    first_face[r] = found.n_listed;
  });
  const std::uint32_t words_of_all = exclusive_scan_in_place(packed->first_word_),
                      n_listed = exclusive_scan_in_place(packed->first_face_);
  if (std::size_t{n_listed} * points_per_listed > on_grid.size.points()) return nullptr;
  packed->words_.resize(words_of_all);
  packed->listed_.resize(n_listed);
  CodeWord* const words = raw(packed->words_);
  ListedFace* const listed = raw(packed->listed_);
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    write_row(all, r, own[r], words + first_word[r], listed + first_face[r]);
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
