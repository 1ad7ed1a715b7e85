// ptx_instructions.h: what the instructions do that translate_ptx.py does not write as an operator of C++.
//
// Registers hold bits: each use says what type it reads them as, and a result narrower than its register is extended by
// its sign. Approximate functions (ex2.approx and the like) are the host's, hence more accurate than a GPU's.
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>

#include "device_memory.h"
#include "kernel.h"
#include "memory_checks.h"
#include "settings.h"
#include "thread_block.h"

namespace cuda_emulator {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

template <std::size_t Bytes>
struct BitsOf;
template <>
struct BitsOf<1> {
  using Type = std::uint8_t;
};
template <>
struct BitsOf<2> {
  using Type = std::uint16_t;
};
template <>
struct BitsOf<4> {
  using Type = std::uint32_t;
};
template <>
struct BitsOf<8> {
  using Type = std::uint64_t;
};

/// The same bits as another type of that size.
template <typename To, typename From>
inline To bits(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

/// A register's lowest bits as a type.
template <typename To, typename From>
inline To as(From from) {
  if constexpr (sizeof(To) == sizeof(From))
    return bits<To>(from);
  else
    return bits<To>(static_cast<typename BitsOf<sizeof(To)>::Type>(bits<typename BitsOf<sizeof(From)>::Type>(from)));
}

/// Puts a value into a register that is at least as wide.
template <typename Register, typename T>
inline void set(Register& to, T value) {
  if constexpr (std::is_same_v<Register, T> || sizeof(Register) == sizeof(T))
    to = bits<Register>(value);
  else if constexpr (std::is_integral_v<Register> && std::is_integral_v<T>)
    to = static_cast<Register>(value);
  else
    to = as<Register>(value);
}

/// An integer as 64 bits that wrap.
template <typename T>
inline std::uint64_t wide(T value) {
  return static_cast<std::uint64_t>(value);
}

// ---- addresses

template <typename T>
inline std::uint64_t address(T* place) {
  return reinterpret_cast<std::uintptr_t>(place);
}
inline std::uint64_t address(std::uint32_t shared_offset) { return shared_offset; }

inline char* in_memory(const Thread*, std::uint64_t start, std::int64_t offset) {
  return reinterpret_cast<char*>(start + static_cast<std::uint64_t>(offset));
}
inline char* in_shared(const Thread* t, std::uint64_t start, std::int64_t offset) {
  return t->shared + static_cast<std::uint32_t>(start + static_cast<std::uint64_t>(offset));
}
inline std::uint64_t shared_address(const Thread* t, std::uint64_t offset) { return address(t->shared + offset); }
inline std::uint64_t shared_offset(const Thread* t, std::uint64_t place) { return place - address(t->shared); }

// ---- memory

template <typename T, int N>
struct Elements {
  T value[N];
};

template <typename T>
inline T load(const char* place) {
  if (__builtin_expect(checking, 0)) note_load(place, sizeof(T), false);
  T value;
  std::memcpy(&value, view(place), sizeof value);
  return value;
}

template <typename T>
inline void store(char* place, T value) {
  if (__builtin_expect(checking, 0)) note_store(place, sizeof value, &value, false);
  std::memcpy(view(place), &value, sizeof value);
}

// Volatile and relaxed accesses see what other threads did meanwhile; one thread runs at a time.
template <typename T>
inline T strong_load(const char* place) {
  if (checking) note_load(place, sizeof(T), true);
  asm volatile("" ::: "memory");
  T value;
  std::memcpy(&value, view(place), sizeof value);
  return value;
}

template <typename T>
inline void strong_store(char* place, T value) {
  if (checking) note_store(place, sizeof value, &value, true);
  std::memcpy(view(place), &value, sizeof value);
  asm volatile("" ::: "memory");
}

/// Replaces a value by change(value); returns the one before.
template <typename T, typename Change>
inline T exchange(char* place, Change change) {
  const T before = strong_load<T>(place);
  strong_store<T>(place, static_cast<T>(change(before)));
  return before;
}
template <typename T>
inline T atomic_add(char* p, T b) {
  return exchange<T>(p, [b](T a) { return a + b; });
}
template <typename T>
inline T atomic_min(char* p, T b) {
  return exchange<T>(p, [b](T a) { return std::min(a, b); });
}
template <typename T>
inline T atomic_max(char* p, T b) {
  return exchange<T>(p, [b](T a) { return std::max(a, b); });
}
template <typename T>
inline T atomic_and(char* p, T b) {
  return exchange<T>(p, [b](T a) { return a & b; });
}
template <typename T>
inline T atomic_or(char* p, T b) {
  return exchange<T>(p, [b](T a) { return a | b; });
}
template <typename T>
inline T atomic_xor(char* p, T b) {
  return exchange<T>(p, [b](T a) { return a ^ b; });
}
template <typename T>
inline T atomic_exch(char* p, T b) {
  return exchange<T>(p, [b](T) { return b; });
}
template <typename T>
inline T atomic_cas(char* p, T compared, T b) {
  return exchange<T>(p, [=](T a) { return a == compared ? b : a; });
}

// ---- arithmetic

template <typename Wide, typename T>
inline Wide multiply_wide(T a, T b) {
  return static_cast<Wide>(static_cast<Wide>(a) * static_cast<Wide>(b));
}

template <typename T>
inline T multiply_high(T a, T b) {
  using Product = std::conditional_t<std::is_signed_v<T>, Int128, UInt128>;
  return static_cast<T>(static_cast<Product>(a) * static_cast<Product>(b) >> CHAR_BIT * sizeof(T));
}

template <typename Register, typename T>
inline void add_with_carry(std::uint32_t& carry, Register& to, T a, T b) {
  const UInt128 sum = static_cast<UInt128>(a) + b + carry;
  carry = static_cast<std::uint32_t>(sum >> CHAR_BIT * sizeof(T)) & 1U;
  set(to, static_cast<T>(sum));
}

template <typename T>
inline T divide(T a, T b) {
  if (b == 0) return static_cast<T>(-1);  // not defined
  if (std::is_signed_v<T> && b == static_cast<T>(-1)) return static_cast<T>(0 - wide(a));
  return static_cast<T>(a / b);
}

template <typename T>
inline T remainder_of(T a, T b) {
  if (b == 0 || (std::is_signed_v<T> && b == static_cast<T>(-1))) return 0;
  return static_cast<T>(a % b);
}

template <typename T>
inline bool unordered(T a, T b) {
  return a != a || b != b;
}

/// Of floating-point numbers the other one where one is NaN, and -0 before +0.
template <typename T>
inline T minimum(T a, T b) {
  if constexpr (std::is_floating_point_v<T>)
    return a != a ? b : b != b ? a : a < b || (a == b && std::signbit(a)) ? a : b;
  else
    return std::min(a, b);
}
template <typename T>
inline T maximum(T a, T b) {
  if constexpr (std::is_floating_point_v<T>)
    return a != a ? b : b != b ? a : a > b || (a == b && std::signbit(b)) ? a : b;
  else
    return std::max(a, b);
}

template <typename T>
inline T absolute(T a) {
  if constexpr (std::is_floating_point_v<T>)
    return std::fabs(a);
  else
    return a < 0 ? static_cast<T>(0 - wide(a)) : a;
}

template <typename T>
inline T saturate(T a) {
  return a > 0 ? std::min(a, T{1}) : T{0};
}
template <typename T>
inline T reciprocal(T a) {
  return T{1} / a;
}
template <typename T>
inline T reciprocal_root(T a) {
  return static_cast<T>(1 / std::sqrt(static_cast<double>(a)));
}

// ---- conversion

enum Rounding { kNearest, kTowardZero, kDown, kUp };

template <Rounding Mode, typename T>
inline T round_to_integer(T a) {
  return Mode == kNearest      ? std::nearbyint(a)
         : Mode == kTowardZero ? std::trunc(a)
         : Mode == kDown       ? std::floor(a)
                               : std::ceil(a);
}

template <typename To, Rounding Mode, typename From>
inline To convert(From from) {
  if constexpr (std::is_floating_point_v<From> && std::is_floating_point_v<To>) {
    if constexpr (sizeof(To) == sizeof(From)) return round_to_integer<Mode>(from);
    static_assert(Mode == kNearest || sizeof(To) >= sizeof(From), "a rounding that is not known");
    return static_cast<To>(from);
  } else if constexpr (std::is_floating_point_v<From>) {
    if (from != from) return sizeof(To) == 8 ? static_cast<To>(std::uint64_t{1} << 63) : To{0};
    const From rounded = round_to_integer<Mode>(from);
    if (rounded >= static_cast<From>(std::numeric_limits<To>::max())) return std::numeric_limits<To>::max();
    if (rounded <= static_cast<From>(std::numeric_limits<To>::min())) return std::numeric_limits<To>::min();
    return static_cast<To>(rounded);
  } else {
    To to = static_cast<To>(from);
    if constexpr (std::is_floating_point_v<To> && Mode != kNearest) {
      const long double error = static_cast<long double>(to) - static_cast<long double>(from);
      const To infinity = std::numeric_limits<To>::infinity();
      if (error > 0 && (Mode == kDown || (Mode == kTowardZero && to > 0))) to = std::nextafter(to, -infinity);
      if (error < 0 && (Mode == kUp || (Mode == kTowardZero && to < 0))) to = std::nextafter(to, infinity);
    }
    return to;
  }
}

// ---- bits

template <typename T>
inline T shift_left(T a, std::uint32_t n) {
  return n >= CHAR_BIT * sizeof(T) ? T{0} : static_cast<T>(wide(a) << n);
}

template <typename T>
inline T shift_right(T a, std::uint32_t n) {
  if (n < CHAR_BIT * sizeof(T)) return static_cast<T>(a >> n);
  return std::is_signed_v<T> && a < 0 ? static_cast<T>(-1) : T{0};
}

inline std::uint32_t funnel_left(std::uint32_t low, std::uint32_t high, std::uint32_t n) {
  return static_cast<std::uint32_t>((wide(high) << 32 | low) << (n & 31U) >> 32);
}
inline std::uint32_t funnel_right(std::uint32_t low, std::uint32_t high, std::uint32_t n) {
  return static_cast<std::uint32_t>((wide(high) << 32 | low) >> (n & 31U));
}

inline std::uint32_t permute_bytes(std::uint32_t a, std::uint32_t b, std::uint32_t selection) {
  const std::uint64_t bytes = wide(b) << 32 | a;
  std::uint32_t result = 0;
  for (unsigned i = 0; i < 4; ++i) {
    const std::uint32_t choice = selection >> 4 * i & 15U;
    std::uint32_t byte = static_cast<std::uint32_t>(bytes >> 8 * (choice & 7U)) & 255U;
    if ((choice & 8U) != 0) byte = (byte & 128U) != 0 ? 255U : 0U;
    result |= byte << 8 * i;
  }
  return result;
}

template <typename T>
inline T extract_bits(T a, std::uint32_t position, std::uint32_t n) {
  constexpr std::uint32_t kBits = CHAR_BIT * sizeof(T);
  position &= 255U;
  n &= 255U;
  if (n == 0) return 0;
  const bool fill = std::is_signed_v<T> && (wide(a) >> std::min(position + n - 1, kBits - 1) & 1U) != 0;
  std::uint64_t result = 0;
  for (std::uint32_t i = 0; i < kBits; ++i) {
    const bool bit = i < n && position + i < kBits ? (wide(a) >> (position + i) & 1U) != 0 : fill;
    result |= wide(bit) << i;
  }
  return static_cast<T>(result);
}

template <typename T>
inline T insert_bits(T from, T into, std::uint32_t position, std::uint32_t n) {
  for (std::uint32_t i = 0; i < (n & 255U) && (position & 255U) + i < CHAR_BIT * sizeof(T); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << ((position & 255U) + i);
    into = static_cast<T>((wide(from) >> i & 1U) != 0 ? wide(into) | bit : wide(into) & ~bit);
  }
  return into;
}

/// n ones from a position on; they end at the register's width.
inline std::uint32_t bit_mask(std::uint32_t position, std::uint32_t n) {
  if (position > 31) return 0;
  const std::uint32_t ones = n > 31 ? ~0U : (1U << n) - 1U;
  return ones << position;
}

template <typename T>
inline std::uint32_t count_ones(T a) {
  return static_cast<std::uint32_t>(__builtin_popcountll(wide(a)));
}

template <typename T>
inline std::uint32_t leading_zeros(T a) {
  return a == 0 ? CHAR_BIT * sizeof(T)
                : static_cast<std::uint32_t>(__builtin_clzll(wide(a))) - (64 - CHAR_BIT * sizeof(T));
}

template <typename T>
inline T reverse_bits(T a) {
  T result = 0;
  for (unsigned i = 0; i < CHAR_BIT * sizeof(T); ++i) result = static_cast<T>(result << 1 | (a >> i & 1));
  return result;
}

template <typename T>
inline std::uint32_t highest_bit(T a) {
  using Bits = typename BitsOf<sizeof(T)>::Type;
  const Bits b = static_cast<Bits>(std::is_signed_v<T> && a < 0 ? ~a : a);
  return b == 0 ? UINT32_MAX : static_cast<std::uint32_t>(CHAR_BIT * sizeof(T)) - 1 - leading_zeros(b);
}

/// table: the result for each of the eight values that three bits can have.
inline std::uint32_t any_logic(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t table) {
  std::uint32_t result = 0;
  for (unsigned i = 0; i < 8; ++i)
    if ((table >> i & 1U) != 0)
      result |= ((i & 4U) != 0 ? a : ~a) & ((i & 2U) != 0 ? b : ~b) & ((i & 1U) != 0 ? c : ~c);
  return result;
}

[[noreturn]] inline void trap() { fail("trap"); }

// ---- what the toolkit's library has

namespace external {

inline void function___assertfail(Thread*, void*, void** arguments) {
  fail("assertion %s", *static_cast<char**>(arguments[0]));
}

/// The format alone: its values are laid out for a GPU.
inline void function_vprintf(Thread*, void* result, void** arguments) {
  std::fputs(*static_cast<char**>(arguments[0]), stderr);
  *static_cast<std::int32_t*>(result) = 0;
}

}  // namespace external
}  // namespace cuda_emulator
