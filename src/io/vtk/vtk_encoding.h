// vtk_encoding.h: the bytes of an array in a VTK XML file: raw or base64, compressed by zlib or not.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace espdiff {

/// How the numbers of a file are stored; what its head says.
struct VtkEncoding {
  bool big_endian = false;
  bool long_headers = false;  ///< lengths have 64 bits, otherwise 32
  bool compressed = false;    ///< by zlib, in blocks
};

/// For decode_array(): the file says how many bytes there are, up to 1,000,000.
constexpr std::uint64_t kAnyLength = ~std::uint64_t{0};

/// This machine's, as a file's head names it: "LittleEndian" or "BigEndian".
const char* vtk_byte_order();

/// The unsigned number in the first `n_bytes` (at most 8) of `bytes`.
std::uint64_t load_unsigned(const char* bytes, std::size_t n_bytes, bool big_endian);

/// Takes the bytes of one array from the start of `encoded`. `n_bytes` is how many it must have; the lengths in the
/// file must agree, which is checked before memory is taken. Returns the bytes: a part of `encoded` where they lie
/// there as they are, otherwise of `storage`, which is overwritten. `n_read` is set to the characters of `encoded` that
/// were used. `array` begins the messages: "PATH:LINE: array 'phi'".
/// @throws FormatError via `path` and `line` (lengths that differ, characters that are not base64, blocks that cannot
///         be unpacked), MemoryError
std::string_view decode_array(std::string_view encoded, bool is_base64, const VtkEncoding& encoding,
                              std::uint64_t n_bytes, std::string& storage, std::size_t& n_read, const std::string& path,
                              long line, const std::string& array);

}  // namespace espdiff
