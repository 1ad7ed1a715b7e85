// dcd_frames.h: the frames of a DCD trajectory, where VMD's readers are not there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/frames/dcd_head.h"
#include "io/structures/coordinate_file.h"
#include "system/open_file.h"

namespace espdiff {

/// Whether a path ends as a DCD does.
bool is_dcd_name(const std::string& path);

/// A DCD as read_dcd_head() knows it. Every frame has the same size, so that it is read where it lies. A unit cell is
/// a, gamma, b, beta, alpha, c; NAMD and newer CHARMM write the cosines of the angles. Atoms that do not move keep
/// their places of the first frame.
class DcdFrames : public CoordinateFile {
 public:
  /// @param n_atoms that each frame must have
  /// @throws IoError (missing), FormatError (no DCD; its head is damaged; no whole frame), InputError (another number
  ///         of atoms)
  DcdFrames(std::string path, std::size_t n_atoms);

  const std::string& path() const override { return path_; }
  int n_frames() const override { return static_cast<int>(head_.n_whole); }
  const CoordinateFrame& frame(int number) override;

 private:
  /// Reads the three coordinates of n atoms at a place of the file. @returns the place behind
  std::uint64_t read_coordinates(int number, std::uint64_t at, std::vector<float> (&axes)[3], std::size_t n) const;
  std::vector<char> record(int number, std::uint64_t& at, std::size_t n_bytes) const;

  std::string path_;
  OpenFile file_;
  DcdHead head_;
  std::vector<Vec3f> first_;  // of the first frame, where some atoms do not move
  CoordinateFrame frame_;
  int held_ = -1;  // the frame in frame_, -1 for none
};

}  // namespace espdiff
