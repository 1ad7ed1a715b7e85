// operator_rows.cu: unpacks a plane of coefficients.
#include "cuda/potential/pb/multigrid/operator_rows.h"

#include <algorithm>
#include <cstring>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The usual dielectrics of a row's faces.
ESPDIFF_MULTIVERSION void usual_faces(const std::uint8_t* codes, float solvent, float solute, int n, float* ex,
                                      float* ey, float* ez) {
#pragma GCC ivdep
  for (int i = 0; i < n; ++i) {
    const int code = codes[i];
    ex[i] = (code & 1) != 0 ? solute : solvent;
    ey[i] = (code & 2) != 0 ? solute : solvent;
    ez[i] = (code & 4) != 0 ? solute : solvent;
  }
}

/// The diagonal of the points from `first` to before `last`: k and the six faces, in the order of
/// add_faces_to_diagonal().
ESPDIFF_MULTIVERSION void diagonal_of(const std::uint8_t* codes, float ions, const OperatorRow& row, float* out) {
  const int first = row.first, last = row.last;
  const float* const ex = row.ex;
  const float* const ey = row.ey;
  const float* const ey_before = row.ey_before;
  const float* const ez = row.ez;
  const float* const ez_below = row.ez_below;
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float faces = (ex[i] + ex[i - 1]) + (ey[i] + ey_before[i]) + (ez[i] + ez_below[i]);
    const int code = codes[i];
    out[i] = ((code & MixedPoints::kIonsBit) != 0 ? ions : 0.0F) + faces;
  }
}

}  // namespace

OperatorRows::OperatorRows(const GridOperator& of, Buffer<float>& storage, PlainEnds ends, RowRange rows)
    : of_(of), storage_(storage), rows_(rows), codes_(of.size.row() + CodeWord::kPoints) {
  if (of.packed != nullptr && ends == PlainEnds::kLeftOut) {
    const PackedView packed = of.packed->view();
    mixed_ = packed.mixed;
    const float e = packed.usual.solvent, faces = (e + e) + (e + e) + (e + e);
    for (const int has_ions : {0, 1})
      plain_diagonal_[has_ions].assign(of.size.row(), (has_ions != 0 ? packed.usual.ions : 0.0F) + faces);
  }
  const std::size_t needed = of.packed == nullptr ? 0 : of.size.plane() * kPlanes * kArrays;
  if (storage.size() >= needed) return;
  storage.resize(needed);
  // Not by assign(): its loop throws when the computation is cancelled, and these rows are made within one.
  std::fill_n(raw(storage), needed, 0.0F);
}

const float* OperatorRows::plane_of(Array array, int k) const {
  if (of_.packed != nullptr && (array != kDiagonal || of_.diagonal.empty()))
    return raw(storage_) + of_.size.plane() * static_cast<std::size_t>(kArrays * (k % kPlanes) + array);
  const Buffer<float>* const arrays[kArrays] = {&of_.ex, &of_.ey, &of_.ez, &of_.diagonal};
  return raw(*arrays[array]) + of_.size.index(0, 0, k);
}

float* OperatorRows::unpacked(Array array, int k) {
  return raw(storage_) + of_.size.plane() * static_cast<std::size_t>(kArrays * (k % kPlanes) + array);
}

MixedPoints OperatorRows::mixed_of(std::size_t row) const {
  if (mixed_ != nullptr) return mixed_[row];
  return {1, static_cast<std::uint32_t>(of_.size.nx - 1), 0};
}

OperatorRow OperatorRows::at(int j, int k) const {
  const std::size_t row = of_.size.row(), first = row * static_cast<std::size_t>(j);
  const MixedPoints mixed =
      mixed_of(static_cast<std::size_t>(j) + static_cast<std::size_t>(of_.size.ny) * static_cast<std::size_t>(k));
  const float* const ey = plane_of(kY, k) + first;
  const float* const diagonal = plane_of(kDiagonal, k) + first;
  const bool has_ends = mixed_ != nullptr;
  return {plane_of(kX, k) + first,
          ey,
          ey - row,
          plane_of(kZ, k) + first,
          plane_of(kZ, k - 1) + first,
          diagonal,
          has_ends && of_.diagonal.empty() ? plain_diagonal_[mixed.has_ions()].data() : diagonal,
          has_ends ? of_.packed->view().usual.solvent : 0.0F,
          static_cast<int>(mixed.first),
          static_cast<int>(mixed.last),
          of_.size.nx - 1};
}

void OperatorRows::hold(int k) {
  if (of_.packed == nullptr || (first_ < k && k <= last_)) return;
  if (last_ != k - 1) {
    first_ = k - 1;
    unpack_faces(k - 1);
  }
  unpack_faces(k);
  if (of_.diagonal.empty()) unpack_diagonal(k);
  last_ = k;
  first_ = std::max(first_, k + 1 - kPlanes);
}

/// The codes of a row at `points`; others of the array are not renewed.
const std::uint8_t* OperatorRows::codes_of(std::size_t row, RowRange points) {
  const PackedView packed = of_.packed->view();
  const MixedPoints own = packed.own[row];
  std::uint8_t* const codes = codes_.data();
  if (points.first < static_cast<int>(own.first) || points.last > static_cast<int>(own.last))
    std::fill(codes + points.first, codes + points.last, static_cast<std::uint8_t>(own.code_of_ends));
  std::uint8_t* next = codes + own.first / CodeWord::kPoints * CodeWord::kPoints;
  for (std::uint32_t w = packed.first_word[row]; w < packed.first_word[row + 1]; ++w) {
    const std::uint64_t word = packed.words[w].codes, halves[2] = {word & CodeWord::kLow, word >> 4 & CodeWord::kLow};
    std::memcpy(next, halves, sizeof halves);
    next += sizeof halves;
  }
  return codes;
}

/// The points of a row whose faces are faces of mixed points: of the row itself, of the next one, or of that above.
RowRange OperatorRows::needed_faces(std::size_t row) const {
  const MixedPoints own = mixed_of(row), next = mixed_of(row + 1),
                    above = mixed_of(row + static_cast<std::size_t>(of_.size.ny));
  RowRange needed{of_.size.nx, 0};
  for (const MixedPoints& mixed : {own, next, above}) {
    if (mixed.first >= mixed.last) continue;
    needed.first = std::min(needed.first, static_cast<int>(mixed.first) - 1);
    needed.last = std::max(needed.last, static_cast<int>(mixed.last));
  }
  return needed;
}

void OperatorRows::unpack_faces(int k) {
  const PackedView packed = of_.packed->view();
  const std::size_t n = of_.size.row(), ny = static_cast<std::size_t>(of_.size.ny);
  float* const faces[3] = {unpacked(kX, k), unpacked(kY, k), unpacked(kZ, k)};
  // The first row's points have faces of the row before.
  for (std::size_t j = static_cast<std::size_t>(rows_.first - 1); j < static_cast<std::size_t>(rows_.last); ++j) {
    const std::size_t row = j + ny * static_cast<std::size_t>(k);
    const RowRange needed = needed_faces(row);
    if (needed.first >= needed.last) continue;
    const std::size_t begin = static_cast<std::size_t>(needed.first), first = n * j + begin;
    usual_faces(codes_of(row, needed) + begin, packed.usual.solvent, packed.usual.solute, needed.last - needed.first,
                faces[0] + first, faces[1] + first, faces[2] + first);
    for (std::uint32_t listed = packed.first_face[row]; listed < packed.first_face[row + 1]; ++listed) {
      const ListedFace& face = packed.listed[listed];
      faces[face.axis()][n * j + face.point()] = face.dielectric;
    }
  }
}

void OperatorRows::unpack_diagonal(int k) {
  const float ions = of_.packed->view().usual.ions;
  const std::size_t n = of_.size.row(), ny = static_cast<std::size_t>(of_.size.ny);
  for (std::size_t j = static_cast<std::size_t>(rows_.first); j < static_cast<std::size_t>(rows_.last); ++j) {
    const OperatorRow row = at(static_cast<int>(j), k);
    if (row.first < row.last)
      diagonal_of(codes_of(j + ny * static_cast<std::size_t>(k), {row.first, row.last}), ions, row,
                  unpacked(kDiagonal, k) + n * j);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
