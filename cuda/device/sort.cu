// sort.cu: radix sort, by CUB on a GPU.
#include "cuda/device/sort.h"

#include <array>
#include <numeric>
#include <utility>

#if defined(ESPDIFF_BACKEND_CUDA)
#include <cub/device/device_radix_sort.cuh>
#endif

namespace espdiff::ESPDIFF_BACKEND {

int bits_below(std::size_t n) {
  int bits = 0;
  while (n > 1 && (n - 1) >> bits != 0) ++bits;
  return bits;
}

#if defined(ESPDIFF_BACKEND_CUDA)

void sort_by_key(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, int n_bits) {
  namespace cub = CUB_NS_QUALIFIER;
  const std::uint32_t n = static_cast<std::uint32_t>(keys.size());
  if (n < 2 || n_bits == 0) return;
  Buffer<std::uint32_t> other_keys(n), other_values(n);
  cub::DoubleBuffer<std::uint32_t> key(raw(keys), raw(other_keys)), value(raw(values), raw(other_values));
  const auto sort = [&](void* scratch, std::size_t& n_bytes) {
    check_cuda(
        cub::DeviceRadixSort::SortPairs(scratch, n_bytes, key, value, n, 0, n_bits, CudaContext::current()->stream()),
        "sorting");
  };
  std::size_t n_bytes = 0;
  sort(nullptr, n_bytes);  // only tells how much memory it needs
  Buffer<unsigned char> scratch(n_bytes);
  sort(raw(scratch), n_bytes);
  if (key.selector != 0) keys.swap(other_keys);
  if (value.selector != 0) values.swap(other_values);
}

#else

// The lowest digit first, which keeps the order of equal keys. By one thread: for a surface's 100,000 keys that is
// faster than Thrust's stable sort by two. Keys travel with their values, and all digits are counted at once.
void sort_by_key(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, int n_bits) {
  constexpr int kDigitBits = 11, kMostDigits = 3;
  constexpr std::uint32_t kMask = (1U << kDigitBits) - 1U;
  struct Pair {
    std::uint32_t key, value;
  };
  const std::size_t n = keys.size();
  if (n < 2 || n_bits == 0) return;
  const int n_digits = (n_bits + kDigitBits - 1) / kDigitBits;
  std::array<std::array<std::uint32_t, kMask + 2>, kMostDigits> places{};  // [digit][its value] of the next key
  Buffer<Pair> pairs(n), sorted(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t key = keys.begin()[i];
    pairs.begin()[i] = {key, values.begin()[i]};
    for (int digit = 0; digit < n_digits; ++digit)
      ++places[static_cast<std::size_t>(digit)][(key >> digit * kDigitBits & kMask) + 1];
  }
  for (int digit = 0; digit < n_digits; ++digit) {
    std::array<std::uint32_t, kMask + 2>& place = places[static_cast<std::size_t>(digit)];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (const Pair& pair : pairs) sorted.begin()[place[pair.key >> digit * kDigitBits & kMask]++] = pair;
    pairs.swap(sorted);
  }
  for (std::size_t i = 0; i < n; ++i) {
    keys.begin()[i] = pairs.begin()[i].key;
    values.begin()[i] = pairs.begin()[i].value;
  }
}

#endif

Rows sort_into_rows(Buffer<std::uint32_t> bucket, std::size_t n_buckets) {
  const std::size_t n = bucket.size();
  Rows rows;
  rows.item.resize(n);
  std::uint32_t* const item = raw(rows.item);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) { item[i] = static_cast<std::uint32_t>(i); });
  sort_by_key(bucket, rows.item, bits_below(n_buckets + 1));
  const std::uint32_t* const sorted = raw(bucket);
  rows.first = first_of_rows(n, n_buckets, [=] ESPDIFF_HD(std::size_t place) { return std::size_t{sorted[place]}; });
  return rows;
}

}  // namespace espdiff::ESPDIFF_BACKEND
