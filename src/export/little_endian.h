// little_endian.h: numbers as the bytes of binary files.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace espdiff {

inline void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((value >> shift) & 0xffU);
}

inline void append_u16(std::string& bytes, std::uint16_t value) {
  bytes += static_cast<char>(value & 0xffU);
  bytes += static_cast<char>(value >> 8);
}

inline void append_f32(std::string& bytes, double value) {
  const auto single = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &single, sizeof bits);
  append_u32(bytes, bits);
}

}  // namespace espdiff
