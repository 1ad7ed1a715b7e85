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

/// Calls run(code, number of points) for the runs of a row, and face(4 * point + axis, value) for its listed faces.
template <typename Run, typename Face>
ESPDIFF_INLINE void visit_row(const CoefficientArrays<const float>& in, std::size_t of_row, Run run, Face face) {
  unsigned before = 0, n = 0;
  for (std::size_t i = 0; i < in.row; ++i) {
    const std::size_t p = of_row * in.row + i;
    unsigned code = in.k[p] != 0.0F ? PackedView::kIonsBit : 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const float value = in.face(axis)[p];
      code |= (value == in.usual.solute ? 1U : 0U) << axis;
      if (value != in.usual_face(code, axis)) face(static_cast<std::uint32_t>(4 * i + axis), value);
    }
    if (n > 0 && (code != before || n == CodeRun::kMostPoints)) {
      run(before, n);
      n = 0;
    }
    before = code;
    ++n;
  }
  run(before, n);
}

ESPDIFF_INLINE void read_row(const CoefficientArrays<float>& out, std::size_t of_row, const PackedView& packed) {
  const std::size_t first = of_row * out.row;
  std::size_t p = first;
  for (std::uint32_t r = packed.first_run[of_row]; r < packed.first_run[of_row + 1]; ++r) {
    const unsigned code = packed.runs[r].code;
    for (const std::size_t end = p + packed.runs[r].n_points; p < end; ++p) {
      out.k[p] = (code & PackedView::kIonsBit) != 0 ? out.usual.ions : 0.0F;
      for (unsigned axis = 0; axis < 3; ++axis) out.face(axis)[p] = out.usual_face(code, axis);
    }
  }
  for (std::uint32_t n = packed.first_face[of_row]; n < packed.first_face[of_row + 1]; ++n) {
    const ListedFace& face = packed.listed[n];
    out.face(face.axis())[first + face.point()] = face.dielectric;
  }
}

std::size_t n_rows(const GridSize& size) {
  return static_cast<std::size_t>(size.ny) * static_cast<std::size_t>(size.nz);
}

/// [row] see PlainRow.
Buffer<std::uint8_t> plain_rows(const PackedView& packed, const GridSize& size) {
  const std::size_t rows = n_rows(size), ny = static_cast<std::size_t>(size.ny);
  Buffer<std::uint8_t> alone(rows), among_others(rows);  // the first: as PlainRow, of the row by itself
  std::uint8_t* const own = raw(alone);
  std::uint8_t* const plain = raw(among_others);
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    const std::uint32_t first = packed.first_run[r];
    const unsigned code = packed.runs[first].code;
    bool is_one = (code & ~PackedView::kIonsBit) == 0 && packed.first_face[r] == packed.first_face[r + 1];
    for (std::uint32_t n = first; n < packed.first_run[r + 1]; ++n) is_one = is_one && packed.runs[n].code == code;
    own[r] = !is_one ? kNotPlain : code != 0 ? kWithIons : kWithoutIons;
  });
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    const bool is_inner = r % ny > 0 && r % ny < ny - 1 && r >= ny && r + ny < rows;
    const bool is_among_plain = is_inner && own[r - 1] != kNotPlain && own[r - ny] != kNotPlain;
    plain[r] = is_among_plain ? own[r] : std::uint8_t{kNotPlain};
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
  packed->first_run_.assign(rows + 1, 0);
  packed->first_face_.assign(rows + 1, 0);
  std::uint32_t* const first_run = raw(packed->first_run_);
  std::uint32_t* const first_face = raw(packed->first_face_);
  const CoefficientArrays<const float> all{raw(on_grid.ex),       raw(on_grid.ey), raw(on_grid.ez),
                                           raw(on_grid.diagonal), usual,           on_grid.size.row()};
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    std::uint32_t n_runs = 0, n_faces = 0;
    visit_row(
        all, r, [&](unsigned, unsigned) { ++n_runs; }, [&](std::uint32_t, float) { ++n_faces; });
    first_run[r] = n_runs;
    first_face[r] = n_faces;
  });
  const std::uint32_t n_runs = exclusive_scan_in_place(packed->first_run_),
                      n_listed = exclusive_scan_in_place(packed->first_face_);
  if (std::size_t{n_listed} * points_per_listed > on_grid.size.points()) return nullptr;
  packed->runs_.resize(n_runs);
  packed->listed_.resize(n_listed);
  CodeRun* const runs = raw(packed->runs_);
  ListedFace* const listed = raw(packed->listed_);
  for_each_index(rows, [=] ESPDIFF_HD(std::size_t r) {
    CodeRun* next_run = runs + first_run[r];
    ListedFace* next_face = listed + first_face[r];
    visit_row(
        all, r,
        [&](unsigned code, unsigned n) {
          *next_run++ = {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(n)};
        },
        [&](std::uint32_t place, float value) {
          *next_face++ = {place, value};
        });
  });
  packed->plain_ = plain_rows(packed->view(), packed->size_);
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
