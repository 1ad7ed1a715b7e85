// spatial_order.h: orders points so that neighbours in the list are neighbours in space.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// [point] indices sorted along the Hilbert curve of the bounding box; ties are broken by index.
Buffer<std::uint32_t> spatial_order(const Buffer<Vec4f>& points);

#if !defined(ESPDIFF_BACKEND_CUDA)
/// Removes the points with nonzero `done` from the first n entries of a list and keeps the order of the rest.
/// @returns the number left
std::size_t drop_done(Buffer<std::uint32_t>& list, std::size_t n, const Buffer<std::uint8_t>& done);
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
