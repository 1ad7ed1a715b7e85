// hdf5_writer.h: what of an ensemble file is written by HDF5: everything but the frames. The only code that calls HDF5.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/types.h"

namespace espdiff {

struct TemplateSurface;

/// Two: of plan and template, and of every byte but the frames'.
inline constexpr const char* kHeadChecksum = "/espdiff/head_checksum";
inline constexpr const char* kTrustedVertices = "/VTKHDF/PointData/trusted";
inline constexpr std::size_t kNoteBytes = 200;

/// Ends messages of files that cannot be used, before switched_on("overwrite").
inline constexpr const char* kBeginAnew = "; begin anew with another output, or with ";
inline IoError not_written(const std::string& path) { return {path, "cannot be written; is the disk full?"}; }

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits) over words of 32 bits, which finds any changed word.
inline constexpr std::uint64_t kChecksumStart = 0xcbf29ce484222325ULL;
inline std::uint64_t add_to_checksum(std::uint64_t sum, const void* bytes, std::size_t n) {
  const auto* const b = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < n; i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, b + i, std::min<std::size_t>(4, n - i));
    sum = (sum ^ word) * 0x100000001b3ULL;
  }
  return sum;
}

/// What stands in the file before the frames, and how many of these there will be.
struct EnsembleHead {
  const std::string& plan;
  const TemplateSurface& surface;
  const std::string& unit;
  std::size_t n_frames;
  const std::vector<std::string>& columns;  ///< names of a frame's numbers
  std::uint64_t checksum;                   ///< of plan and surface
};

/// A dataset as it should be in the file.
struct WrittenDataset {
  std::string name;
  std::uint64_t checksum;
};

/// Writes the file `place` and reserves the frames' space.
/// @param path for messages  @returns the datasets with values, to find again
/// @throws IoError, DeviceError (the program's part that has HDF5 is missing)
std::vector<WrittenDataset> write_by_hdf5(const std::string& place, const std::string& path, const EnsembleHead& head);

/// Why nothing can be written by HDF5 here, with the remedy; empty if it can.
std::string hdf5_problem();

}  // namespace espdiff
