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

/// [row + 1] the first of some items that are sorted by row. Waits for nothing.
/// @param row_of (item) below n_rows, or n_rows for those of no row
template <typename RowOf>
Buffer<std::uint32_t> first_of_rows(std::size_t n_items, std::size_t n_rows, RowOf row_of) {
  Buffer<std::uint32_t> first_of(n_rows + 1);
  std::uint32_t* const first = raw(first_of);
  // Each item begins the rows after that of the item before it, up to its own.
  for_each_index(n_items + 1, [=] ESPDIFF_HD(std::size_t item) {
    const std::size_t begin = item == 0 ? 0 : row_of(item - 1) + 1, end = item == n_items ? n_rows : row_of(item);
    for (std::size_t row = begin; row <= end; ++row) first[row] = static_cast<std::uint32_t>(item);
  });
  return first_of;
}

}  // namespace espdiff::ESPDIFF_BACKEND
