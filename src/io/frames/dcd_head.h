// dcd_head.h: what the head of a DCD trajectory promises, and how many whole frames the file's size has room for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace espdiff {

/// A DCD as CHARMM, NAMD and X-PLOR write it, in either order of bytes, with record marks of 4 or 8 bytes, with or
/// without unit cells, a fourth dimension and atoms that do not move.
struct DcdHead {
  std::int64_t n_atoms = 0;
  std::int64_t n_promised = 0;  ///< frames by the head; 0 where it does not say
  std::int64_t n_whole = 0;     ///< frames that the file's size has room for
  std::uint64_t n_rest = 0;     ///< bytes after them
  std::uint64_t n_frame = 0;    ///< bytes of a frame that would follow
  // For who reads the frames.
  std::uint64_t begin = 0, n_first = 0;  ///< where the first frame lies, and its bytes
  std::size_t mark_bytes = 4;
  bool is_swapped = false, has_cell = false;
  std::int64_t n_fixed = 0;
  std::vector<std::size_t> moving{};  ///< indices of the atoms that move; empty where all do

  /// What of the file is missing, in words: the end of a frame, or promised frames. Empty for a whole file. A file may
  /// have more frames than its head promises: not every program that adds some rewrites it.
  std::string missing() const;
};

/// @returns nothing for a file that does not begin as a DCD, or cannot be read: its reader says why
/// @throws FormatError (it begins as a DCD, and its head is cut off or contradicts itself)
std::optional<DcdHead> read_dcd_head(const std::string& path);

}  // namespace espdiff
