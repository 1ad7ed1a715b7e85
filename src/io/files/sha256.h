// sha256.h: fingerprints of input files, for the provenance of a result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace espdiff {

/// The secure hash SHA-256 (FIPS 180-4, sections 4 to 6) of bytes that come in pieces.
class Sha256 {
 public:
  /// @param by_instructions uses the processor's own, several times as fast; the digests are the same
  explicit Sha256(bool by_instructions = has_instructions()) : by_instructions_(by_instructions) {}

  /// Whether the processor has instructions for it.
  static bool has_instructions();

  void update(const void* bytes, std::size_t n_bytes);
  /// 64 lower-case hexadecimal digits of all bytes so far; ends the computation.
  std::string finish();

 private:
  static std::array<std::uint32_t, 8> initial_state();
  void compress(const std::uint8_t* block);

  bool by_instructions_;
  std::array<std::uint32_t, 8> state_ = initial_state();
  std::array<std::uint8_t, 64> block_{};
  std::size_t n_in_block_ = 0;
  std::uint64_t n_bytes_ = 0;
};

/// Of bytes in memory.
std::string sha256_of(std::string_view bytes);

/// Of a file's content, as `sha256sum` prints it. Reads 64 kB at a time.
/// @throws IoError (missing, a folder, unreadable)
std::string sha256_of_file(const std::string& path);

}  // namespace espdiff
