// amber_frames.h: Amber's coordinates: restart files, in text and NetCDF, and NetCDF trajectories.
#pragma once

#include <memory>
#include <string>

#include "io/files/read_input.h"
#include "io/structures/coordinate_file.h"
#include "io/structures/netcdf_file.h"

namespace espdiff {

/// A restart in text (inpcrd, rst7), one frame: see FileKind::kAmberRestart. Specification: ambermd.org, "Amber file
/// formats".
class AmberRestart : public CoordinateFile {
 public:
  /// Velocities are passed over; behind them or the coordinates stands the cell, if any.
  /// @throws FormatError (with line: cut off, no number where a coordinate should be)
  explicit AmberRestart(const FileContent& file);

  const std::string& path() const override { return path_; }
  int n_frames() const override { return 1; }
  const CoordinateFrame& frame(int /*number*/) override { return frame_; }

 private:
  std::string path_;
  CoordinateFrame frame_;
};

/// A NetCDF file of Amber's conventions (ambermd.org/netcdf): a trajectory, or a restart with one frame.
class AmberNetcdf : public CoordinateFile {
 public:
  /// @throws FormatError (no coordinates of atoms in Angstrom, no whole frame)
  explicit AmberNetcdf(ByteSource source);

  const std::string& path() const override { return file_.path(); }
  int n_frames() const override { return n_frames_; }
  const CoordinateFrame& frame(int number) override;
  /// What of the frames is missing, in words; empty where nothing is.
  std::string missing() const { return file_.missing(); }

 private:
  NetcdfFile file_;
  const NetcdfVariable* coordinates_ = nullptr;
  int n_frames_ = 0;
  CoordinateFrame frame_;
  int held_ = -1;  // the frame in frame_, -1 for none
};

/// Coordinates in one of these formats, as they were read. @throws as the two classes
std::unique_ptr<CoordinateFile> amber_frames(FileContent file);

}  // namespace espdiff
