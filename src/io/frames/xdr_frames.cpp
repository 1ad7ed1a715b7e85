// xdr_frames.cpp: XDR numbers, the highest byte first. XTC: 13 numbers, the number of atoms, packed coordinates; TRR: a
// name, the sizes of ten blocks, three numbers, two real ones, the blocks.
#include "io/frames/xdr_frames.h"

#include <array>
#include <cstddef>

#include "system/open_file.h"

namespace espdiff {
namespace {

constexpr std::uint64_t kXtcMagic = 1995, kLargeXtcMagic = 2023, kTrrMagic = 1993;
constexpr std::uint64_t kUnpackedAtoms = 9;  // at most so many are written as they are

/// The begin of a frame.
class FrameHead {
 public:
  FrameHead(const OpenFile& file, std::uint64_t at, std::uint64_t n_left)
      : n_(n_left < bytes_.size() ? static_cast<std::size_t>(n_left) : bytes_.size()) {
    is_read_ = file.read_at(at, bytes_.data(), n_) == 0;
  }
  bool is_read() const { return is_read_; }
  bool has(std::size_t n_bytes) const { return n_ >= n_bytes; }
  /// @returns 0 where it would be beyond the end
  std::uint64_t number(std::size_t at) const {
    if (!has(at + 4)) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8U | bytes_[at + i];
    return value;
  }

 private:
  std::array<unsigned char, 96> bytes_{};
  std::size_t n_;
  bool is_read_ = false;
};

/// Bytes of a frame; 0 where its head is cut off.
std::uint64_t xtc_bytes(const FrameHead& head) {
  constexpr std::size_t kAtoms = 52, kCoordinates = 56, kPacked = 88;
  if (!head.has(kCoordinates)) return 0;
  const std::uint64_t n_atoms = head.number(kAtoms);
  if (n_atoms <= kUnpackedAtoms) return kCoordinates + 12 * n_atoms;
  const bool is_large = head.number(0) == kLargeXtcMagic;
  const std::size_t begin = kPacked + (is_large ? 8 : 4);
  if (!head.has(begin)) return 0;
  const std::uint64_t n = is_large ? head.number(kPacked) << 32U | head.number(kPacked + 4) : head.number(kPacked);
  return begin + (n + 3) / 4 * 4;
}

/// @param has_positions receives whether they are among the blocks
std::uint64_t trr_bytes(const FrameHead& head, bool& has_positions) {
  constexpr std::size_t kNameLength = 8, kName = 12, kSizes = 10, kNumbers = 13, kBox = 2, kPositions = 7;
  const std::uint64_t n_name = (head.number(kNameLength) + 3) / 4 * 4;
  const std::size_t sizes = kName + static_cast<std::size_t>(n_name < 16 ? n_name : 16);
  if (!head.has(sizes + 4 * kNumbers)) return 0;
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < kSizes; ++i) n += head.number(sizes + 4 * i);
  // Real numbers are as long as those of the box, or of the positions.
  const std::uint64_t box = head.number(sizes + 4 * kBox), positions = head.number(sizes + 4 * kPositions);
  const std::uint64_t n_atoms = head.number(sizes + 4 * kSizes);
  has_positions = positions > 0;
  const std::uint64_t real = box > 0 ? box / 9 : n_atoms > 0 ? positions / (3 * n_atoms) : 4;
  return sizes + 4 * kNumbers + 2 * real + n;
}

}  // namespace

std::optional<XdrFrames> read_xdr_frames(const std::string& path) {
  const OpenFile file(path, FileAccess::kReadPipe);
  if (!file) return std::nullopt;
  const std::uint64_t n_bytes = file.size();
  XdrFrames frames;
  std::uint64_t first_magic = 0;
  for (std::uint64_t at = 0; at < n_bytes;) {
    const std::uint64_t n_left = n_bytes - at;
    const FrameHead head(file, at, n_left);
    if (!head.is_read()) return std::nullopt;
    const std::uint64_t magic = head.number(0);
    if (at == 0) {
      if (magic != kXtcMagic && magic != kLargeXtcMagic && magic != kTrrMagic) return std::nullopt;
      first_magic = magic;
    }
    const std::string number = std::to_string(frames.n_whole);
    if (head.has(4) && magic != first_magic) {
      frames.missing = "is damaged: no frame begins where frame " + number + " should";
      return frames;
    }
    bool has_positions = true;
    const std::uint64_t n_frame = magic == kTrrMagic ? trr_bytes(head, has_positions) : xtc_bytes(head);
    if (n_frame == 0 || n_frame > n_left) {
      frames.missing = "is cut off in frame " + number + " (" + std::to_string(n_left) +
                       (n_frame == 0 ? " bytes of it are there)" : " of " + std::to_string(n_frame) + " bytes)");
      return frames;
    }
    at += n_frame;
    frames.have_positions = frames.have_positions && has_positions;
    ++frames.n_whole;
  }
  return n_bytes == 0 ? std::nullopt : std::optional<XdrFrames>(frames);
}

}  // namespace espdiff
