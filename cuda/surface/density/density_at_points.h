// density_at_points.h: the analytic density and its gradient at arbitrary points.
#pragma once

#include "cuda/surface/density/atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Analytic density (thesis eq. 3.1, truncated at 4.5 s) and its gradient.
struct DensitySample {
  float value;
  Vec3f gradient;  ///< 1/Angstrom
};

/// Samples the listed points: samples[list[i]] for i < n. Adds atoms in the order of the cell list in both forms. The
/// list should be in spatial order: the CPU processes points in blocks that share their atoms.
void density_at_points(const AtomCells& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                       std::size_t n, Buffer<DensitySample>& samples);

/// The general form, point by point; gives the same bits.
void density_point_by_point(const AtomCells& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                            std::size_t n, Buffer<DensitySample>& samples);

}  // namespace espdiff::ESPDIFF_BACKEND
