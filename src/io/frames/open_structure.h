// open_structure.h: opens structure files, and trajectories with the atoms of another file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/progress.h"
#include "base/types.h"
#include "io/structures/structure_file.h"

namespace espdiff {

struct FrameReader;
struct MolfileReader;

/// How a file is opened as a StructureFile.
using OpenStructure = std::function<std::unique_ptr<StructureFile>(const std::string& path)>;

/// Whether a file is a trajectory or the like, whose atoms come from another file.
bool has_coordinates_alone(const std::string& path);

/// A structure file. @throws as StructureFile
std::unique_ptr<StructureFile> open_structure(const std::string& path);

/// Opens Amber's coordinates, and what VMD's readers read, or where they are absent frame_reader() and DcdFrames.
/// Trajectories get the atoms of a structure or topology.
class TrajectoryOpener {
 public:
  /// @param topology a structure file, or a topology that VMD reads (PSF, prmtop, GRO, ...)
  /// @param plugins  folder of VMD's molfile plugins; empty: find_molfile_folder()
  /// @param progress stays; can cancel open()
  TrajectoryOpener(std::string topology, std::string plugins, const Progress& progress);

  /// Whether the topology has no coordinates that are read here, so that they come from a trajectory.
  bool needs_coordinates() const { return needs_coordinates_; }
  /// Of the topology as its atoms were read; empty as long as no trajectory needed them.
  const std::string& sha256() const { return sha256_; }
  /// A file of frames. Where the topology is itself coordinates alone, such as an Amber restart, it needs_atoms().
  /// @throws as StructureFile, CoordinateFile, read_molfile_atoms(), take_topology(); DeviceError (VMD's readers are
  ///         not found); InputError (none of them reads this ending)
  std::unique_ptr<StructureFile> open(const std::string& path);

 private:
  const FrameReader* other_reader_of(const std::string& path);
  const MolfileReader& reader_of(const std::string& path);
  std::shared_ptr<const Molecule> atoms();

  std::string topology_, plugins_, sha256_;
  const Progress& progress_;
  bool needs_coordinates_ = false;
  std::shared_ptr<const Molecule> atoms_;  // all of the topology's, once a trajectory needs them
};

}  // namespace espdiff
