// molfile_file.h: topologies and trajectories through VMD's readers, one frame at a time.
#pragma once

#include <cstddef>
#include <string>

#include "base/progress.h"
#include "base/types.h"
#include "io/frames/molfile_plugins.h"
#include "io/structures/coordinate_file.h"

namespace espdiff {

/// A trajectory through one of VMD's readers. Going back begins at the file's first frame again. The reader runs in
/// this process: it is trusted as VMD trusts it.
class MolfileFrames : public CoordinateFile {
 public:
  /// Reads through the file once, to count its frames.
  /// @param n_atoms that each frame must have
  /// @param progress can cancel the count
  /// @throws IoError (missing), InputError (another number of atoms; the reader has no coordinates), FormatError (it
  ///         cannot be opened by the reader; no frame)
  MolfileFrames(std::string path, const MolfileReader& reader, std::size_t n_atoms, const Progress& progress);
  ~MolfileFrames() override;
  MolfileFrames(const MolfileFrames&) = delete;
  MolfileFrames& operator=(const MolfileFrames&) = delete;

  const std::string& path() const override { return path_; }
  int n_frames() const override { return n_frames_; }
  const CoordinateFrame& frame(int number) override;

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
/// file has them, otherwise radii by element.
/// @throws IoError (missing), FormatError (it cannot be read), InputError (the reader knows no atoms)
Molecule read_molfile_atoms(const std::string& path, const MolfileReader& reader);

}  // namespace espdiff
