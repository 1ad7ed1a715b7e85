// molfile_file.h: topologies and trajectories through VMD's readers, one frame at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/types.h"
#include "base/unit_cell.h"
#include "io/molfile_plugins.h"

namespace espdiff {

/// One frame of a trajectory.
struct CoordinateFrame {
  std::vector<Vec3f> positions;  ///< [atom] Angstrom
  std::optional<UnitCell> cell;  ///< none where the file has none, or edges of 1 A and less
};

/// A file of coordinates. Frames are read in any order; going back begins at the file's first again. A reader of VMD's
/// runs in this process: it is trusted as VMD trusts it.
class CoordinateFile {
 public:
  /// Reads through the file once, to count its frames.
  /// @param n_atoms that each frame must have
  /// @param progress can cancel the count
  /// @throws IoError (missing), InputError (another number of atoms; the reader has no coordinates), FormatError (it
  ///         cannot be opened by the reader; no frame)
  CoordinateFile(std::string path, const MolfileReader& reader, std::size_t n_atoms, const Progress& progress);
  ~CoordinateFile();
  CoordinateFile(const CoordinateFile&) = delete;
  CoordinateFile& operator=(const CoordinateFile&) = delete;

  const std::string& path() const { return path_; }
  int n_frames() const { return n_frames_; }
  /// A frame, which stays until another one is asked for.
  /// @param number from 0. @throws FormatError (the frame is damaged; a coordinate is not finite)
  const CoordinateFrame& frame(int number);

 private:
  void open();
  void close();
  /// Reads the next frame into frame_. @returns false at the end of the file
  bool next();

  std::string path_;
  const MolfileReader& reader_;
  std::size_t n_atoms_ = 0;
  void* handle_ = nullptr;
  int n_frames_ = 0, at_ = 0;  // at_: the frame that is read next
  int held_ = -1;              // the frame in frame_, -1 for none
  CoordinateFrame frame_;
};

/// The atoms of a topology (PSF, prmtop, GRO, ...), all at the origin: names, residues, charges and radii where the
/// file has them, else radii by element.
/// @throws IoError (missing), FormatError (it cannot be read), InputError (the reader knows no atoms)
Molecule read_molfile_atoms(const std::string& path, const MolfileReader& reader);

}  // namespace espdiff
