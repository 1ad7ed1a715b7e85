// weighted_order.cu: sorts values by their bits, and finds quantiles by the sums of chunks and one look into a chunk
// each.
#include "cuda/certificate/weighted_order.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "cuda/device/sort.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::uint32_t kSign = 0x80000000U;

ESPDIFF_INLINE std::uint32_t bits_of(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

ESPDIFF_INLINE float from_bits(std::uint32_t bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// Integers in the order of the floats: those of negative floats are reversed and come first.
ESPDIFF_INLINE std::uint32_t ordered_bits(float x) {
  const std::uint32_t bits = bits_of(x);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

float from_ordered_bits(std::uint32_t bits) { return from_bits((bits & kSign) != 0 ? bits & ~kSign : ~bits); }

void set_bits(const Buffer<float>& values, const Buffer<float>& weights, Buffer<std::uint32_t>& keys,
              Buffer<std::uint32_t>& weight_bits) {
  std::uint32_t *const key = raw(keys), *const bits = raw(weight_bits);
  const float *const value = raw(values), *const weight = raw(weights);
  for_each_index(values.size(), [=] ESPDIFF_HD(std::size_t i) {
    key[i] = ordered_bits(value[i]);
    bits[i] = bits_of(weight[i]);
  });
}

Buffer<double> sums_of_chunks(const Buffer<std::uint32_t>& weight_bits) {
  const std::uint32_t* const bits = raw(weight_bits);
  return chunk_sums<double>(weight_bits.size(),
                            [=] ESPDIFF_HD(std::size_t i) { return static_cast<double>(from_bits(bits[i])); });
}

/// A chunk that a quantile lies in.
struct Chunk {
  double before = 0;  ///< the weights of all chunks before it
  std::vector<std::uint32_t> keys, weights;
};

}  // namespace

WeightedOrder::WeightedOrder(const Buffer<float>& values, const Buffer<float>& weights)
    : keys_(values.size()), weights_(values.size()) {
  set_bits(values, weights, keys_, weights_);
  sort_by_key(keys_, weights_, 32);
  chunks_ = sums_of_chunks(weights_);
}

void WeightedOrder::read_sums(HostReads& reads) { read_elements(reads, sums_, chunks_, 1, chunks_.size() - 1); }

std::vector<float> WeightedOrder::quantiles(double total, const std::vector<double>& shares) const {
  std::vector<Chunk> chunks(shares.size());
  HostReads reads;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    std::size_t chunk = 0;
    double before = 0;
    for (; chunk + 1 < sums_.size() && !(before + sums_[chunk] >= shares[s] * total); ++chunk) before += sums_[chunk];
    chunks[s].before = before;
    const std::size_t begin = chunk * kReductionChunk, n = std::min(kReductionChunk, keys_.size() - begin);
    read_elements(reads, chunks[s].keys, keys_, begin, n);
    read_elements(reads, chunks[s].weights, weights_, begin, n);
  }
  reads.wait();
  std::vector<float> values;
  for (std::size_t s = 0; s < shares.size(); ++s) {
    const Chunk& chunk = chunks[s];
    double below = chunk.before;
    std::size_t i = 0;
    for (; i + 1 < chunk.keys.size(); ++i) {
      below += static_cast<double>(from_bits(chunk.weights[i]));
      if (below >= shares[s] * total) break;
    }
    values.push_back(from_ordered_bits(chunk.keys[i]));
  }
  return values;
}

}  // namespace espdiff::ESPDIFF_BACKEND
