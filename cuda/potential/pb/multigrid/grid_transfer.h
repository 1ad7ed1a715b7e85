// grid_transfer.h: between a grid and the next coarser one.
#pragma once

#include "cuda/potential/pb/multigrid/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The coarse grid's size and coefficients, from the fine grid's faces, and its diagonal or packed k.
void coarsen(const GridOperator& fine, GridOperator& coarse);

/// The coarse face of fine ones that all have one dielectric, rounded as coarsen() rounds it.
float coarse_face_of_equal(float dielectric);

/// b of the coarse grid, the restricted residual.
void restrict_to(const GridSize& fine, const Buffer<float>& r, const GridSize& coarse, Buffer<float>& b);

/// x += trilinear interpolation of the coarse grid's.
void add_interpolated(const GridSize& coarse, const Buffer<float>& correction, const GridSize& fine, Buffer<float>& x);

}  // namespace espdiff::ESPDIFF_BACKEND
