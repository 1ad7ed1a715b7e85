// open_structure.cpp: which reader opens a file: ours for structures and Amber's files, VMD's for everything else, ours
// for PSF and DCD without VMD.
#include "io/frames/open_structure.h"

#include <utility>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/files/sha256.h"
#include "io/frames/dcd_frames.h"
#include "io/frames/frame_reader.h"
#include "io/frames/molfile_file.h"
#include "io/frames/molfile_plugins.h"
#include "io/structures/amber_frames.h"
#include "io/structures/read_topology.h"

namespace espdiff {
namespace {

/// How to do without VMD: in Python as it is there, or by another front end.
std::string without_plugins(const std::string& path) {
  if (!frame_reader_remedy().empty()) return frame_reader_remedy();
  return "; without VMD, Python's espdiff reads it by MDAnalysis (in its repository: pip install '.[mda]'), and " +
         std::string(is_dcd_name(path) ? "DCD needs its atoms from a PSF, PDB or PQR"
                                       : "DCD and PSF are read without either");
}

}  // namespace

bool has_coordinates_alone(const std::string& path) {
  const FileKind kind = kind_of_file(path);
  return needs_molfile_reader(path) || kind == FileKind::kAmberRestart || kind == FileKind::kNetcdf;
}

std::unique_ptr<StructureFile> open_structure(const std::string& path) { return std::make_unique<StructureFile>(path); }

TrajectoryOpener::TrajectoryOpener(std::string topology, std::string plugins, const Progress& progress)
    : topology_(std::move(topology)),
      plugins_(std::move(plugins)),
      progress_(progress),
      needs_coordinates_(needs_molfile_reader(topology_)) {}

/// The surrounding program's reader, where VMD's are neither named nor found, or do not read such a file.
const FrameReader* TrajectoryOpener::other_reader_of(const std::string& path) {
  plugins_ = find_molfile_folder(plugins_);
  return plugins_.empty() || find_molfile_reader(plugins_, path) == nullptr ? frame_reader() : nullptr;
}

const MolfileReader& TrajectoryOpener::reader_of(const std::string& path) {
  plugins_ = find_molfile_folder(plugins_);
  if (plugins_.empty())
    throw DeviceError((path + ": is read by VMD's molfile plugins, and none were found; " + kMolfileRemedy + " as " +
                       option("plugins") + without_plugins(path))
                          .set_next({frame_reader_remedy().empty() ? "python3 -m " : "", {}}));
  const MolfileReader* const reader = find_molfile_reader(plugins_, path);
  if (reader == nullptr)
    throw InputError(Message(path + ": no plugin of VMD in " + plugins_ +
                             " reads files with this ending; Python's espdiff reads it by MDAnalysis (in its "
                             "repository: pip install '.[mda]')")
                         .set_next({frame_reader_remedy().empty() ? "python3 -m " : "", {}}));
  return *reader;
}

std::shared_ptr<const Molecule> TrajectoryOpener::atoms() {
  if (atoms_ != nullptr) return atoms_;
  Molecule all;
  if (!needs_coordinates_) {
    const StructureFile file(topology_);
    all = file.read({1, true, true, {}});
    sha256_ = file.sha256();
  } else {
    const FileKind kind = kind_of_file(topology_);
    const FrameReader* const other = other_reader_of(topology_);
    sha256_ = sha256_of_file(topology_);
    if (kind == FileKind::kPrmtop || (kind == FileKind::kPsf && other == nullptr && plugins_.empty())) {
      all = read_topology_atoms(topology_);
    } else {
      all = other != nullptr ? other->read_atoms(topology_) : read_molfile_atoms(topology_, reader_of(topology_));
      if (kind == FileKind::kPsf) take_topology(all, read_topology(topology_));
    }
  }
  atoms_ = std::make_shared<const Molecule>(std::move(all));
  return atoms_;
}

std::unique_ptr<StructureFile> TrajectoryOpener::open(const std::string& path) {
  const FileKind kind = kind_of_file(path);
  const bool has_atoms = needs_coordinates_ || !has_coordinates_alone(topology_);
  if (kind == FileKind::kNetcdf)  // read frame by frame
    return std::make_unique<StructureFile>(std::make_unique<AmberNetcdf>(bytes_of_file(path)),
                                           has_atoms ? atoms() : nullptr);
  if (kind == FileKind::kAmberRestart || !needs_molfile_reader(path)) {
    auto file = open_structure(path);
    return file->needs_atoms() && has_atoms ? std::make_unique<StructureFile>(amber_frames(read_input(path)), atoms())
                                            : std::move(file);
  }
  require_regular_file(path);
  if (const FrameReader* const other = other_reader_of(path); other != nullptr) {
    const std::shared_ptr<const Molecule> all = atoms();
    return std::make_unique<StructureFile>(other->open(path, all->size()), all);
  }
  if (plugins_.empty() && is_dcd_name(path)) {
    const std::shared_ptr<const Molecule> all = atoms();
    return std::make_unique<StructureFile>(std::make_unique<DcdFrames>(path, all->size()), all);
  }
  const MolfileReader& reader = reader_of(path);
  const std::shared_ptr<const Molecule> all = atoms();
  return std::make_unique<StructureFile>(std::make_unique<MolfileFrames>(path, reader, all->size(), progress_), all);
}

}  // namespace espdiff
