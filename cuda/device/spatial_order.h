// spatial_order.h: orders points so that neighbours in the list are neighbours in space.
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

/// Morton code of a point with coordinates from 0 to 1023.
ESPDIFF_INLINE std::uint32_t morton_code(Vec3f p) {
  return spread_bits(static_cast<std::uint32_t>(p.x)) | spread_bits(static_cast<std::uint32_t>(p.y)) << 1 |
         spread_bits(static_cast<std::uint32_t>(p.z)) << 2;
}

constexpr int kMortonBits = 30;

/// What the coordinates in a box are multiplied by for morton_code().
ESPDIFF_INLINE float morton_scale(Vec3f lower, Vec3f upper) {
  const Vec3f size = upper - lower;
  return 1023.0F / larger(larger(size.x, size.y), larger(size.z, 1e-6F));
}

/// [point] indices sorted along the Morton curve of the bounding box; ties are broken by index.
Buffer<std::uint32_t> spatial_order(const Buffer<Vec4f>& points);

#if !defined(ESPDIFF_BACKEND_CUDA)
/// Removes the points with nonzero `done` from the first n entries of a list and keeps the order of the rest.
/// @returns the number left
std::size_t drop_done(Buffer<std::uint32_t>& list, std::size_t n, const Buffer<std::uint8_t>& done);
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
