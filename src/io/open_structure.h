// open_structure.h: opens structure files, and trajectories with the atoms of another file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/types.h"
#include "io/structure_file.h"

namespace espdiff {

struct MolfileReader;

/// How a file is opened as a StructureFile.
using OpenStructure = std::function<std::unique_ptr<StructureFile>(const std::string& path)>;

/// A structure file: PQR, PDB or mmCIF. @throws as StructureFile
std::unique_ptr<StructureFile> open_structure(const std::string& path);

/// Opens what VMD's readers read as well. Trajectories get the atoms of a structure or topology.
class TrajectoryOpener {
 public:
  /// @param topology a structure file, or a topology that VMD reads (PSF, prmtop, GRO, ...)
  /// @param plugins  folder of VMD's molfile plugins; empty: find_molfile_folder()
  /// @throws as StructureFile, read_molfile_atoms(); DeviceError (no readers for a topology)
  TrajectoryOpener(std::string topology, std::string plugins);

  /// Whether the topology has no coordinates that are read here, so that they come from a trajectory.
  bool needs_coordinates() const { return needs_coordinates_; }
  /// A file of frames. @throws as StructureFile, CoordinateFile; DeviceError (no reader for a trajectory)
  std::unique_ptr<StructureFile> open(const std::string& path);

 private:
  const MolfileReader& reader_of(const std::string& path);
  std::shared_ptr<const Molecule> atoms();

  std::string topology_, plugins_;
  bool needs_coordinates_ = false;
  std::shared_ptr<const Molecule> atoms_;  // all of the topology's, once a trajectory needs them
};

}  // namespace espdiff
