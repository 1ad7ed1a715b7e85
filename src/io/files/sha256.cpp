// sha256.cpp: FIPS 180-4; its constants are computed, not typed.
#include "io/files/sha256.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#if defined(__GNUC__) && defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#define ESPDIFF_SHA_INSTRUCTIONS
#endif

#include "base/error.h"
#include "base/text/system_message.h"
#include "io/files/read_input.h"

namespace espdiff {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr bool is_prime(unsigned n) {
  for (unsigned d = 2; d * d <= n; ++d) {
    if (n % d == 0) return false;
  }
  return n > 1;
}

/// The first 32 bits of the fractional part of the square (power 2) or cube root (power 3) of `n`, exactly: the largest
/// r with r^power <= n * 2^(32 power) is the root times 2^32.
constexpr std::uint32_t root_fraction(unsigned n, int power) {
  const Wide limit = static_cast<Wide>(n) << (32 * power);
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 37; bit != 0; bit >>= 1) {
    const Wide trial = root | bit;
    const Wide value = power == 2 ? trial * trial : trial * trial * trial;
    if (value <= limit) root |= bit;
  }
  return static_cast<std::uint32_t>(root);
}

/// Root fractions of the first primes.
template <std::size_t Size>
constexpr std::array<std::uint32_t, Size> prime_root_fractions(int power) {
  std::array<std::uint32_t, Size> fractions{};
  unsigned candidate = 2;
  for (std::size_t i = 0; i < Size; ++candidate) {
    if (is_prime(candidate)) fractions[i++] = root_fraction(candidate, power);
  }
  return fractions;
}

constexpr std::array<std::uint32_t, 64> kRoundConstants = prime_root_fractions<64>(3);
constexpr std::array<std::uint32_t, 8> kInitial = prime_root_fractions<8>(2);
static_assert(kRoundConstants[0] == 0x428a2f98 && kInitial[0] == 0x6a09e667, "FIPS 180-4, sections 4.2.2 and 5.3.3");

constexpr std::uint32_t rotate_right(std::uint32_t x, int n) { return (x >> n) | (x << (32 - n)); }

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

#if defined(ESPDIFF_SHA_INSTRUCTIONS)

/// Compresses a block by the instructions of x86-64, two rounds each. They keep the state as (a, b, e, f) and
/// (c, d, g, h), the first highest, and four words of the message in each vector, the first lowest.
__attribute__((target("sha,sse4.1"))) void compress_by_instructions(const std::uint8_t* block,
                                                                    std::array<std::uint32_t, 8>& state) {
  const auto four = [](std::uint32_t highest, std::uint32_t b, std::uint32_t c, std::uint32_t lowest) {
    return _mm_set_epi32(static_cast<int>(highest), static_cast<int>(b), static_cast<int>(c), static_cast<int>(lowest));
  };
  auto& [a, b, c, d, e, f, g, h] = state;
  const __m128i abef_before = four(a, b, e, f), cdgh_before = four(c, d, g, h);
  __m128i abef = abef_before, cdgh = cdgh_before, words[4];
  const __m128i big_endian = four(0x0c0d0e0f, 0x08090a0b, 0x04050607, 0x00010203);
  const auto load = [](const void* at) { return _mm_loadu_si128(static_cast<const __m128i*>(at)); };
  for (int k = 0; k < 4; ++k) words[k] = _mm_shuffle_epi8(load(block + 16 * k), big_endian);
#pragma GCC unroll 16  // so that the words stay in registers
  for (std::size_t t = 0; t < 16; ++t) {
    __m128i& now = words[t % 4];
    if (t >= 4) {
      const __m128i after = words[(t + 1) % 4], later = words[(t + 2) % 4], latest = words[(t + 3) % 4];
      now = _mm_add_epi32(_mm_sha256msg1_epu32(now, after), _mm_alignr_epi8(latest, later, 4));
      now = _mm_sha256msg2_epu32(now, latest);
    }
    const __m128i sums = _mm_add_epi32(now, load(&kRoundConstants[4 * t]));
    cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sums);
    abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sums, 0x0e));
  }
  alignas(16) std::uint32_t of_abef[4], of_cdgh[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(of_abef), _mm_add_epi32(abef, abef_before));
  _mm_store_si128(reinterpret_cast<__m128i*>(of_cdgh), _mm_add_epi32(cdgh, cdgh_before));
  state = {of_abef[3], of_abef[2], of_cdgh[3], of_cdgh[2], of_abef[1], of_abef[0], of_cdgh[1], of_cdgh[0]};
}

#endif

}  // namespace

bool Sha256::has_instructions() {
#if defined(ESPDIFF_SHA_INSTRUCTIONS)
  unsigned a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned kFeatures = 7, kSha = 1U << 29;  // CPUID's leaf, and its bit of EBX
  return __get_cpuid_count(kFeatures, 0, &a, &b, &c, &d) != 0 && (b & kSha) != 0;
#else
  return false;
#endif
}

std::array<std::uint32_t, 8> Sha256::initial_state() { return kInitial; }

void Sha256::compress(const std::uint8_t* block) {
#if defined(ESPDIFF_SHA_INSTRUCTIONS)
  if (by_instructions_) return compress_by_instructions(block, state_);
#endif
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t) w[t] = big_endian(block + 4 * t);
  for (std::size_t t = 16; t < 64; ++t) {
    const std::uint32_t s0 = rotate_right(w[t - 15], 7) ^ rotate_right(w[t - 15], 18) ^ (w[t - 15] >> 3);
    const std::uint32_t s1 = rotate_right(w[t - 2], 17) ^ rotate_right(w[t - 2], 19) ^ (w[t - 2] >> 10);
    w[t] = w[t - 16] + s0 + w[t - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t choose = (e & f) ^ (~e & g), majority = (a & b) ^ (a & c) ^ (b & c);
    const std::uint32_t sum1 = rotate_right(e, 6) ^ rotate_right(e, 11) ^ rotate_right(e, 25);
    const std::uint32_t sum0 = rotate_right(a, 2) ^ rotate_right(a, 13) ^ rotate_right(a, 22);
    const std::uint32_t t1 = h + sum1 + choose + kRoundConstants[t] + w[t], t2 = sum0 + majority;
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<std::uint32_t, 8> rounds = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state_[i] += rounds[i];
}

void Sha256::update(const void* bytes, std::size_t n_bytes) {
  const auto* next = static_cast<const std::uint8_t*>(bytes);
  n_bytes_ += n_bytes;
  while (n_bytes > 0) {
    const std::size_t n_taken = std::min(n_bytes, block_.size() - n_in_block_);
    std::memcpy(block_.data() + n_in_block_, next, n_taken);
    next += n_taken;
    n_bytes -= n_taken;
    n_in_block_ += n_taken;
    if (n_in_block_ < block_.size()) return;
    compress(block_.data());
    n_in_block_ = 0;
  }
}

std::string Sha256::finish() {
  // A one bit, zeros, and the length in bits fill the last block.
  const std::uint64_t n_bits = 8 * n_bytes_;
  const std::uint8_t one = 0x80, zero = 0;
  update(&one, 1);
  while (n_in_block_ != 56) update(&zero, 1);
  std::array<std::uint8_t, 8> length{};
  for (std::size_t i = 0; i < 8; ++i) length[i] = static_cast<std::uint8_t>(n_bits >> (56 - 8 * i));
  update(length.data(), length.size());
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[(word >> shift) & 15];
  }
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  return hash.finish();
}

std::string sha256_of_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw IoError(path, "is a folder, not a file; name a file in it");
  if (std::filesystem::exists(path, ignored)) require_regular_file(path);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw IoError(path, std::string("cannot read: ") + system_message(errno) + "; check the name and its permissions");
  Sha256 hash;
  std::vector<char> chunk(std::size_t{1} << 16);
  while (in.read(chunk.data(), static_cast<std::streamsize>(chunk.size())) || in.gcount() > 0) {
    hash.update(chunk.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) throw IoError(path, "cannot read to the end; the file or its disk is damaged");
  return hash.finish();
}

}  // namespace espdiff
