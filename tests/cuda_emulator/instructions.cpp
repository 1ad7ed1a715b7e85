// instructions.cpp: what ptx_instructions.h makes of instructions, by the values that the PTX manual's words give.
#include "ptx_instructions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace cuda_emulator;

TEST_SUITE_BEGIN("ptx_instructions");

TEST_CASE("registers hold bits: what is narrower is extended by its sign") {
  std::uint32_t wide_register = 0;
  set(wide_register, static_cast<std::int8_t>(-2));
  CHECK(wide_register == 0xFFFFFFFEU);
  set(wide_register, static_cast<std::uint8_t>(0xFE));
  CHECK(wide_register == 0xFEU);
  CHECK(as<std::int16_t>(std::uint32_t{0x1234FFFF}) == -1);
  CHECK(as<float>(std::uint32_t{0x3F800000}) == 1.0F);
  float float_register = 0;
  set(float_register, std::uint32_t{0xC0000000});
  CHECK(float_register == -2.0F);
}

TEST_CASE("integers wrap, and their products are wide or high") {
  CHECK(multiply_wide<std::int64_t>(std::int32_t{-3}, std::int32_t{1 << 30}) == -3221225472LL);
  CHECK(multiply_wide<std::uint64_t>(0xFFFFFFFFU, 0xFFFFFFFFU) == 0xFFFFFFFE00000001ULL);
  CHECK(multiply_high(std::int32_t{-1}, std::int32_t{1}) == -1);
  CHECK(multiply_high(std::uint64_t{1} << 63, std::uint64_t{4}) == 2);
  CHECK(divide(std::int32_t{-7}, std::int32_t{2}) == -3);
  CHECK(divide(INT32_MIN, std::int32_t{-1}) == INT32_MIN);
  CHECK(remainder_of(std::int32_t{-7}, std::int32_t{2}) == -1);
  std::uint32_t carry = 0, low = 0, high = 0;
  add_with_carry(carry, low, 0xFFFFFFFFU, 2U);
  add_with_carry(carry, high, 5U, 6U);
  CHECK(low == 1);
  CHECK(high == 12);
}

TEST_CASE("shifts stop at the register's width") {
  CHECK(shift_left(1U, 31) == 0x80000000U);
  CHECK(shift_left(1U, 32) == 0);
  CHECK(shift_right(std::int32_t{-8}, 1) == -4);
  CHECK(shift_right(std::int32_t{-8}, 99) == -1);
  CHECK(shift_right(0x80000000U, 99) == 0);
  CHECK(funnel_left(0x80000000U, 1U, 1) == 3);
  CHECK(funnel_left(0x12345678U, 0x9ABCDEF0U, 32) == 0x9ABCDEF0U);
  CHECK(funnel_right(0x12345678U, 0x9ABCDEF0U, 8) == 0xF0123456U);
}

TEST_CASE("bits and bytes") {
  CHECK(permute_bytes(0x33221100U, 0x77665544U, 0x7410) == 0x77441100U);
  CHECK(permute_bytes(0x00000080U, 0, 0x0008) == 0x808080FFU);  // the sign of byte 0, then byte 0 three times
  CHECK(extract_bits(0x0000F0F0U, 4, 8) == 0x0FU);
  CHECK(extract_bits(std::int32_t{0x00000080}, 4, 4) == -8);
  CHECK(insert_bits(0xFU, 0xFFFF0000U, 4, 8) == 0xFFFF00F0U);
  CHECK(bit_mask(4, 8) == 0x0FF0U);
  CHECK(bit_mask(0, 32) == 0xFFFFFFFFU);
  CHECK(bit_mask(28, 8) == 0xF0000000U);
  CHECK(bit_mask(3, 0) == 0);
  CHECK(bit_mask(32, 4) == 0);
  CHECK(count_ones(0xF0F0ULL) == 8);
  CHECK(leading_zeros(1U) == 31);
  CHECK(leading_zeros(0U) == 32);
  CHECK(leading_zeros(std::uint64_t{1}) == 63);
  CHECK(reverse_bits(1U) == 0x80000000U);
  CHECK(highest_bit(0x10U) == 4);
  CHECK(highest_bit(0U) == UINT32_MAX);
  CHECK(highest_bit(std::int32_t{-1}) == UINT32_MAX);
  CHECK(any_logic(0xF0F0F0F0U, 0xCCCCCCCCU, 0xAAAAAAAAU, 0x96) == (0xF0F0F0F0U ^ 0xCCCCCCCCU ^ 0xAAAAAAAAU));
}

TEST_CASE("numbers that are none, and signs of zero") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(minimum(nan, 2.0F) == 2.0F);
  CHECK(maximum(2.0F, nan) == 2.0F);
  CHECK(std::signbit(minimum(0.0F, -0.0F)));
  CHECK_FALSE(std::signbit(maximum(-0.0F, 0.0F)));
  CHECK(unordered(nan, 1.0F));
  CHECK(saturate(nan) == 0.0F);
  CHECK(saturate(1.5F) == 1.0F);
}

TEST_CASE("conversions round as they say, and stop at the ends of integers") {
  CHECK(convert<std::int32_t, kTowardZero>(-2.7F) == -2);
  CHECK(convert<std::int32_t, kNearest>(2.5F) == 2);
  CHECK(convert<std::int32_t, kDown>(-2.1) == -3);
  CHECK(convert<std::int32_t, kUp>(2.1) == 3);
  CHECK(convert<std::int32_t, kTowardZero>(3e9F) == INT32_MAX);
  CHECK(convert<std::uint32_t, kTowardZero>(-1.0F) == 0);
  CHECK(convert<std::int32_t, kTowardZero>(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(convert<float, kDown>(2.7F) == 2.0F);
  CHECK(convert<float, kNearest>(std::int32_t{16777217}) == 16777216.0F);
  CHECK(convert<float, kUp>(std::int32_t{16777217}) == 16777218.0F);
  CHECK(convert<float, kTowardZero>(std::int32_t{-16777219}) == -16777218.0F);
}

TEST_SUITE_END();
