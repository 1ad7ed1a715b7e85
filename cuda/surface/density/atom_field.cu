// atom_field.cu: weighted means and sums of atoms' values at points.
#include "cuda/surface/density/atom_field.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// An atom's value, less what values are counted from; both 0 where it has none.
struct AtomValue {
  float value, has_value;
};

struct Reading {
  AtomCellsView cells;
  float origin;             ///< what values are counted from, so that those of equal atoms come out exactly
  const AtomValue* values;  ///< [sorted atom]
  PointList points;
  float* result;  ///< [vertex]
};

/// Sums of one kind; T is a float, or a vector of them.
template <typename T>
struct ValueSums {
  T density{}, known{}, value{};

  ESPDIFF_INLINE void add(float v, float has_value, const T& gaussian) {
    density += gaussian;
    known += has_value * gaussian;
    value += v * gaussian;
  }
};

/// NaN where no atom reaches, or most of the density is of atoms without a value.
ESPDIFF_INLINE float mean_of(float origin, float density, float known, float value) {
  return known > 0.0F && 2.0F * known >= density ? origin + value / known : NAN;
}

ESPDIFF_INLINE float mean_at(const Reading& in, Vec3f p) {
  ValueSums<float> sums;
  sum_at_point(in.cells, p,
               [&](std::uint32_t a, float, float, float, float, float, float gaussian)
                   ESPDIFF_INLINE_LAMBDA { sums.add(in.values[a].value, in.values[a].has_value, gaussian); });
  return mean_of(in.origin, sums.density, sums.known, sums.value);
}

/// NaN where no atom reaches. The cells hold atoms with a value only, and their reach is kDecayReach_A.
ESPDIFF_INLINE float decay_sum_at(const Reading& in, Vec3f p) {
  float sum = 0;
  int n = 0;
  sum_at_point(in.cells, p,
               [&](std::uint32_t a, float, float, float, float, float square, float) ESPDIFF_INLINE_LAMBDA {
                 sum += in.values[a].value * exp_of_negative(-sqrtf(square));
                 ++n;
               });
  return n > 0 ? sum : NAN;
}

void read_by_points(const Reading& in, AtomWeight weight) {
  const bool is_mean = weight == AtomWeight::kDensityMean;
  for_each_index(in.points.n, [=] ESPDIFF_HD(std::size_t v) {
    const Vec3f p = in.points.points[v].xyz();
    in.result[v] = is_mean ? mean_at(in, p) : decay_sum_at(in, p);
  });
}

#if !defined(__CUDACC__)

template <std::size_t N>
ESPDIFF_INLINE void mean_block(const Reading& in, const SharedAtoms& near, std::size_t begin) {
  using Numbers = typename LaneTypes<N>::Numbers;
  ValueSums<Numbers> sums;
  sum_at_block<N>(in.cells, near, in.points, begin,
                  [&](std::uint32_t a, float, const Numbers&, const Numbers&, const Numbers&, const Numbers&,
                      const Numbers& gaussian)
                      ESPDIFF_INLINE_LAMBDA { sums.add(in.values[a].value, in.values[a].has_value, gaussian); });
  for (std::size_t lane = 0; lane < N && begin + lane < in.points.n; ++lane)
    in.result[in.points.list[begin + lane]] =
        mean_of(in.origin, sums.density[lane], sums.known[lane], sums.value[lane]);
}

template <std::size_t N>
ESPDIFF_INLINE void mean_points(const Reading& in, std::size_t begin, std::size_t end) {
  SharedAtoms near;
  near.find<N>(in.cells, in.points, begin, end);
  for (std::size_t block = begin; block < end; block += N) mean_block<N>(in, near, block);
}

ESPDIFF_NARROW_VERSION void mean_narrow(const Reading& in, std::size_t begin, std::size_t end) {
  mean_points<kBlock>(in, begin, end);
}
ESPDIFF_WIDE_VERSION void mean_wide(const Reading& in, std::size_t begin, std::size_t end) {
  mean_points<kWideBlock>(in, begin, end);
}

#endif

/// Atoms on the device with their values.
struct UploadedValues {
  std::shared_ptr<AtomCells> cells;
  float origin = 0;
  Buffer<AtomValue> sorted;

  explicit UploadedValues(const AtomValues& atoms) {
    if (atoms.widths.size() != atoms.positions.size() || atoms.values.size() != atoms.positions.size())
      throw InputError("atom_field: needs one width and one value per atom");
    const auto is_known = [](float v) { return std::isfinite(v); };
    const auto first = std::find_if(atoms.values.begin(), atoms.values.end(), is_known);
    if (first == atoms.values.end()) throw InputError("atom_field: no atom has a value");
    const bool is_mean = atoms.weight == AtomWeight::kDensityMean;
    if (is_mean) origin = *first;
    std::vector<float> widths = atoms.widths;
    std::vector<AtomValue> values;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const float v = atoms.values[i];
      values.push_back(is_known(v) ? AtomValue{v - origin, 1.0F} : AtomValue{0.0F, 0.0F});
      if (!is_mean) widths[i] = is_known(v) ? static_cast<float>(kDecayReach_A) / kCutoffInWidths : 0.0F;
    }
    Buffer<std::uint32_t> order;
    cells = make_atom_cells(atoms.positions, widths, std::vector<std::int32_t>(widths.size(), 0), &order);
    sorted = in_cell_order(values, order);
  }

  Reading reading(const PointList& points, Buffer<float>& result) const {
    return {cells->view(), origin, raw(sorted), points, raw(result)};
  }
};

}  // namespace

Buffer<float> atom_field_point_by_point(const SurfaceMesh& mesh, const AtomValues& atoms) {
  const UploadedValues uploaded(atoms);
  Buffer<float> result(mesh.n_vertices());
  read_by_points(uploaded.reading({raw(mesh.positions), nullptr, mesh.n_vertices()}, result), atoms.weight);
  return result;
}

Buffer<float> atom_field(const SurfaceMesh& mesh, const AtomValues& atoms) {
#if defined(__CUDACC__)
  return atom_field_point_by_point(mesh, atoms);
#else
  if (atoms.weight != AtomWeight::kDensityMean) return atom_field_point_by_point(mesh, atoms);
  const UploadedValues uploaded(atoms);
  const std::size_t n = mesh.n_vertices();
  const Buffer<std::uint32_t> order = spatial_order(mesh.positions);
  Buffer<float> result(n);
  const Reading in = uploaded.reading({raw(mesh.positions), raw(order), n}, result);
  for_all_blocks(n, in, mean_narrow, mean_wide);
  return result;
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
