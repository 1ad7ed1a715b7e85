// hilbert_curve.h: places along the Hilbert curve. What is next to each other on it, unlike on the Morton curve, is so
// in space, too: boxes of a few points are smaller.
#pragma once

#include <cstdint>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Spreads the lowest 10 bits to every third bit.
ESPDIFF_INLINE std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000FFU;
  v = (v | v << 8) & 0x0300F00FU;
  v = (v | v << 4) & 0x030C30C3U;
  return (v | v << 2) & 0x09249249U;
}

/// Two levels of the curve at once: for each of 24 orientations and each of 64 cells (bits of x, y and z, interleaved)
/// the place along the curve (six bits) and the orientation within the cell. After C. Hamilton, Compact Hilbert
/// Indices, Dalhousie University CS-2006-07 (2006), for three axes.
struct HilbertTable {
  static constexpr int kStates = 24, kCells = 64;
  std::uint16_t entries[kStates * kCells];

  constexpr HilbertTable() : entries() {
    for (int state = 0; state < kStates; ++state) {
      for (int cell = 0; cell < kCells; ++cell) {
        int entry = state / 3, axis = state % 3, place = 0;
        for (const int octant : {cell >> 3, cell & 7}) {
          const int gray = turned_right(octant ^ entry, axis + 1);
          const int i = gray ^ gray >> 1 ^ gray >> 2;
          place = place << 3 | i;
          const int before = i == 0 ? 0 : (i - 1) / 2 * 2;
          entry ^= turned_left(before ^ before >> 1, axis + 1);
          axis = (axis + (i == 0 ? 0 : trailing_ones(i % 2 == 0 ? i - 1 : i)) + 1) % 3;
        }
        entries[kCells * state + cell] = static_cast<std::uint16_t>((3 * entry + axis) << 6 | place);
      }
    }
  }

 private:
  static constexpr int turned_right(int bits, int by) { return (bits >> by % 3 | bits << (3 - by % 3)) & 7; }
  static constexpr int turned_left(int bits, int by) { return turned_right(bits, 3 - by % 3); }
  static constexpr int trailing_ones(int bits) {
    int n = 0;
    for (; (bits & 1) != 0; bits >>= 1) ++n;
    return n;
  }
};

/// Place along the Hilbert curve of a point with coordinates from 0 to 1023.
ESPDIFF_INLINE std::uint32_t hilbert_code(Vec3f p) {
  static constexpr HilbertTable kTable;
  const std::uint32_t cells = spread_bits(static_cast<std::uint32_t>(p.x)) |
                              spread_bits(static_cast<std::uint32_t>(p.y)) << 1 |
                              spread_bits(static_cast<std::uint32_t>(p.z)) << 2;
  std::uint32_t code = 0, state = 0;
  for (int shift = 24; shift >= 0; shift -= 6) {
    const std::uint32_t entry = kTable.entries[state << 6 | (cells >> shift & 63U)];
    code = code << 6 | (entry & 63U);
    state = entry >> 6;
  }
  return code;
}

constexpr int kHilbertBits = 30;

/// What the coordinates in a box are multiplied by for hilbert_code().
ESPDIFF_INLINE float hilbert_scale(Vec3f lower, Vec3f upper) {
  const Vec3f size = upper - lower;
  return 1023.0F / larger(larger(size.x, size.y), larger(size.z, 1e-6F));
}

}  // namespace espdiff::ESPDIFF_BACKEND
