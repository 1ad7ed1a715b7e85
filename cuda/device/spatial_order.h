// spatial_order.h: an order of points in which neighbours in the list are neighbours in space.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Spreads the lowest 10 bits to every third bit.
ESPDIFF_INLINE std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000FFU;
  v = (v | v << 8) & 0x0300F00FU;
  v = (v | v << 4) & 0x030C30C3U;
  return (v | v << 2) & 0x09249249U;
}

/// Place along the Morton curve of a point with coordinates from 0 to 1023.
ESPDIFF_INLINE std::uint32_t morton_code(Vec3f p) {
  return spread_bits(static_cast<std::uint32_t>(p.x)) | spread_bits(static_cast<std::uint32_t>(p.y)) << 1 |
         spread_bits(static_cast<std::uint32_t>(p.z)) << 2;
}

/// [point] the points' indices along the Morton curve of their box; equal codes in the order of the indices.
Buffer<std::uint32_t> spatial_order(const Buffer<Vec4f>& points);

/// Drops the points whose entry in `done` is nonzero from the first n of a list; the rest keeps its order.
/// @returns how many are left
std::size_t drop_done(Buffer<std::uint32_t>& list, std::size_t n, const Buffer<std::uint8_t>& done);

}  // namespace espdiff::ESPDIFF_BACKEND
