// counter_random.h: random numbers as a function of seed and counters, the same in any order and on any thread.
#pragma once

#include <cstdint>

namespace espdiff {

/// Mixes 64 bits (Steele, Lea & Flood 2014, SplitMix64).
constexpr std::uint64_t mix_bits(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// A random number that depends on its arguments only: draw `counter` of stream `stream` of a seed.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return mix_bits(mix_bits(mix_bits(seed) ^ stream) ^ counter);
}

/// A random index below n; biased by less than n / 2^32.
/// @pre 0 < n < 2^32
constexpr std::uint64_t random_below(std::uint64_t n, std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return ((random_bits(seed, stream, counter) >> 32) * n) >> 32;
}

}  // namespace espdiff
