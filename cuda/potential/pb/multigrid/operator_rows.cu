// operator_rows.cu: unpacks a plane of coefficients.
#include "cuda/potential/pb/multigrid/operator_rows.h"

#include <algorithm>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The usual dielectrics of a row's faces.
ESPDIFF_MULTIVERSION void usual_faces(const std::uint8_t* codes, float solvent, float solute, std::size_t n, float* ex,
                                      float* ey, float* ez) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const int code = codes[i];
    ex[i] = (code & 1) != 0 ? solute : solvent;
    ey[i] = (code & 2) != 0 ? solute : solvent;
    ez[i] = (code & 4) != 0 ? solute : solvent;
  }
}

/// The diagonal of inner points: k and the six faces, in the order of add_faces_to_diagonal().
ESPDIFF_MULTIVERSION void diagonal_of(const std::uint8_t* codes, float ions, const OperatorRow& row, std::size_t n,
                                      float* out) {
  const float* const ex = row.ex;
  const float* const ey = row.ey;
  const float* const ey_before = row.ey_before;
  const float* const ez = row.ez;
  const float* const ez_below = row.ez_below;
#pragma GCC ivdep
  for (std::size_t i = 1; i < n - 1; ++i) {
    const float faces = (ex[i] + ex[i - 1]) + (ey[i] + ey_before[i]) + (ez[i] + ez_below[i]);
    const int code = codes[i];
    out[i] = ((code & PackedView::kIonsBit) != 0 ? ions : 0.0F) + faces;
  }
}

}  // namespace

OperatorRows::OperatorRows(const GridOperator& of, Buffer<float>& storage, PlainRows plain, RowRange rows)
    : of_(of), storage_(storage), rows_(rows), codes_(of.size.row()) {
  if (of.packed != nullptr && plain == PlainRows::kLeftOut) {
    const PackedView packed = of.packed->view();
    plain_ = packed.plain;
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

OperatorRow OperatorRows::at(int j, int k) const {
  const std::size_t row = of_.size.row(), first = row * static_cast<std::size_t>(j);
  const std::uint8_t plain =
      plain_of(static_cast<std::size_t>(j) + static_cast<std::size_t>(of_.size.ny) * static_cast<std::size_t>(k));
  if (plain != kNotPlain) {
    const float* const diagonal =
        of_.diagonal.empty() ? plain_diagonal_[plain == kWithIons ? 1 : 0].data() : plane_of(kDiagonal, k) + first;
    return {nullptr, nullptr, nullptr, nullptr, nullptr, diagonal, of_.packed->view().usual.solvent};
  }
  const float* const ey = plane_of(kY, k) + first;
  return {plane_of(kX, k) + first,        ey,  ey - row, plane_of(kZ, k) + first, plane_of(kZ, k - 1) + first,
          plane_of(kDiagonal, k) + first, 0.0F};
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

const std::uint8_t* OperatorRows::codes_of(std::size_t row) {
  const PackedView packed = of_.packed->view();
  std::uint8_t* next = codes_.data();
  for (std::uint32_t r = packed.first_run[row]; r < packed.first_run[row + 1]; ++r)
    next = std::fill_n(next, packed.runs[r].n_points, packed.runs[r].code);
  return codes_.data();
}

void OperatorRows::unpack_faces(int k) {
  const PackedView packed = of_.packed->view();
  const std::size_t n = of_.size.row(), ny = static_cast<std::size_t>(of_.size.ny);
  float* const faces[3] = {unpacked(kX, k), unpacked(kY, k), unpacked(kZ, k)};
  // The first row's points have faces of the row before.
  for (std::size_t j = static_cast<std::size_t>(rows_.first - 1); j < static_cast<std::size_t>(rows_.last); ++j) {
    const std::size_t row = j + ny * static_cast<std::size_t>(k), first = n * j;
    // Faces belong to the next rows' points as well.
    if (plain_of(row) != kNotPlain && plain_of(row + 1) != kNotPlain && plain_of(row + ny) != kNotPlain) continue;
    usual_faces(codes_of(row), packed.usual.solvent, packed.usual.solute, n, faces[0] + first, faces[1] + first,
                faces[2] + first);
    for (std::uint32_t listed = packed.first_face[row]; listed < packed.first_face[row + 1]; ++listed) {
      const ListedFace& face = packed.listed[listed];
      faces[face.axis()][first + face.point()] = face.dielectric;
    }
  }
}

void OperatorRows::unpack_diagonal(int k) {
  const float ions = of_.packed->view().usual.ions;
  const std::size_t n = of_.size.row(), ny = static_cast<std::size_t>(of_.size.ny);
  for (std::size_t j = static_cast<std::size_t>(rows_.first); j < static_cast<std::size_t>(rows_.last); ++j) {
    const std::size_t row = j + ny * static_cast<std::size_t>(k);
    if (plain_of(row) == kNotPlain)
      diagonal_of(codes_of(row), ions, at(static_cast<int>(j), k), n, unpacked(kDiagonal, k) + n * j);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
