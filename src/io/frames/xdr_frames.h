// xdr_frames.h: the frames of XTC and TRR trajectories (GROMACS), which no head counts, from the sizes that they name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace espdiff {

struct XdrFrames {
  std::int64_t n_whole = 0;
  bool have_positions =
      true;               ///< all of them; a TRR may have frames of velocities alone, which readers leave out or not
  std::string missing{};  ///< what follows the whole frames, in words; empty where nothing does
};

/// Goes from frame to frame, by a read of at most 96 bytes each: 10^5 frames take tenths of a second.
/// @returns nothing for a file that does not begin as XTC or TRR, or cannot be read: its reader says why
std::optional<XdrFrames> read_xdr_frames(const std::string& path);

}  // namespace espdiff
