// sort.h: sorting by integer keys, and into rows by bucket.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Bits of the largest integer below n; 0 if that is 0 or none.
int bits_below(std::size_t n);

/// Sorts keys in ascending order and their values with them; the values of equal keys keep their order. A GPU takes one
/// pass for 8 bits. Waits for nothing.
/// @param keys    their lowest n_bits are compared; the others are 0
/// @param values  as many
void sort_by_key(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, int n_bits);

/// Items by bucket: row b, first[b] .. first[b + 1] - 1, holds those of bucket b, ascending.
struct Rows {
  Buffer<std::uint32_t> first;  ///< [bucket + 1]
  Buffer<std::uint32_t> item;   ///< [place]
};

/// Sorts items into the rows of their buckets. Waits for nothing.
/// @param bucket  [item] below n_buckets, or n_buckets itself for items of no row, which come after all rows
Rows sort_into_rows(Buffer<std::uint32_t> bucket, std::size_t n_buckets);

}  // namespace espdiff::ESPDIFF_BACKEND
