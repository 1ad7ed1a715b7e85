// structure_file.cpp: finds out what a structure file is and hands it to the reader for it; frames of trajectories.
#include "io/structures/structure_file.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/joined_words.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/coordinate_file.h"
#include "io/structures/structure_format.h"

namespace espdiff {
namespace {

/// "give a PQR, PDB, mmCIF or GRO file"
std::string other_format() {
  std::vector<std::string> names;
  for (const StructureFormat& format : structure_formats()) names.push_back(format.name);
  return "give a " + joined_words(names) + " file";
}

[[noreturn]] void refuse_as_structure(const std::string& path, FileKind kind) {
  std::string remedy = other_format();
  switch (kind) {
    case FileKind::kDx:
    case FileKind::kCube:
    case FileKind::kVti:
    case FileKind::kVtkXml:
    case FileKind::kVtkLegacy:
    case FileKind::kCcp4: remedy = "that is no structure; " + remedy; break;
    case FileKind::kPsf:
    case FileKind::kPrmtop:
    case FileKind::kDcd:
    case FileKind::kNetcdf:
      remedy =
          "the command line's trajectories take topology and frames as they are; otherwise load both in VMD and use "
          "espdiff there, or write a PQR from VMD and give that";
      break;
    case FileKind::kBinaryCif:
    case FileKind::kMmtf:
    case FileKind::kMmjson: remedy = "fetch the same entry as mmCIF or PDB"; break;
    default: break;
  }
  throw InputError(path + ": this looks like " + describe(kind) + ", which is not read as a structure; " + remedy);
}

/// The format of a structure. @throws InputError for a file that is none
const StructureFormat& format_of_structure(const std::string& path, std::string_view head) {
  const FileKind kind = recognise(head);
  for (const StructureFormat& format : structure_formats()) {
    if (format.is(head, kind)) return format;
  }
  refuse_as_structure(path, kind);
}

/// The frames of a trajectory, with the atoms of another file.
class TrajectoryModels : public StructureModels {
 public:
  TrajectoryModels(std::unique_ptr<CoordinateFile> file, std::shared_ptr<const Molecule> atoms)
      : file_(std::move(file)), atoms_(std::move(atoms)) {}

  int n_models() const override { return file_->n_frames(); }
  std::optional<UnitCell> unit_cell(int model) const override { return frame(model).cell; }

  Molecule read(const StructureOptions& options) const override {
    Molecule molecule = *atoms_;
    const CoordinateFrame& read = frame(options.model);
    for (std::size_t i = 0; i < molecule.size(); ++i) molecule.positions[i] = static_cast<Vec3d>(read.positions[i]);
    molecule.name = file_->path() + ", frame " + std::to_string(options.model - 1);
    if (!options.assembly.empty())
      throw InputError(file_->path() + ": is a trajectory, which describes no assemblies; leave " + option("assembly") +
                       " out");
    return keep_kinds(molecule, options);
  }

 private:
  const CoordinateFrame& frame(int model) const {
    if (model < 1 || model > file_->n_frames())
      throw InputError(file_->path() + ": there is no frame " + std::to_string(model - 1) + "; it has " +
                       std::to_string(file_->n_frames()) + ", from 0");
    const CoordinateFrame& read = file_->frame(model - 1);
    for (std::size_t i = 0; i < read.positions.size(); ++i) check_position(read.positions[i], i, model - 1);
    return read;
  }

  /// A frame that was damaged is an error of its own; the others are good. Not finite is not below the limit.
  void check_position(const Vec3f& p, std::size_t atom, int number) const {
    constexpr float kFarthest_A = 1e6F;
    const auto is_possible = [](float x) { return std::fabs(x) <= kFarthest_A; };
    if (is_possible(p.x) && is_possible(p.y) && is_possible(p.z)) return;
    throw FormatError(file_->path(), 0,
                      "frame " + std::to_string(number) + ": atom " + std::to_string(atom) +
                          formatted(" is at (%g, %g, %g) A", static_cast<double>(p.x), static_cast<double>(p.y),
                                    static_cast<double>(p.z)) +
                          ", and coordinates are numbers within 10^6 A; write the frame again, or leave it out");
  }

  std::unique_ptr<CoordinateFile> file_;
  std::shared_ptr<const Molecule> atoms_;
};

}  // namespace

StructureFile::StructureFile(const std::string& path) : path_(path) {
  const StructureFormat* format = nullptr;
  FileContent file = read_input(path, [&](std::string_view head) { format = &format_of_structure(path, head); });
  sha256_ = file.sha256;
  models_ = format->open(std::move(file));
}

StructureFile::StructureFile(std::unique_ptr<CoordinateFile> frames, std::shared_ptr<const Molecule> atoms)
    : path_(frames->path()), models_(std::make_unique<TrajectoryModels>(std::move(frames), std::move(atoms))) {}

StructureFile::~StructureFile() = default;

const std::string& StructureFile::sha256() const {
  if (sha256_.empty()) sha256_ = sha256_of_file(path_);
  return sha256_;
}

void StructureFile::require_unchanged(const std::string& before) const {
  if (before.empty() || before == sha256()) return;
  throw IoError(path_, "the file was changed while it was in use; start again");
}

int StructureFile::n_models() const { return models_->n_models(); }
std::optional<UnitCell> StructureFile::unit_cell(int model) const { return models_->unit_cell(model); }
long StructureFile::line_of(int model, const Residue& residue) const { return models_->line_of(model, residue); }
Molecule StructureFile::read(const StructureOptions& options) const { return models_->read(options); }

Molecule read_structure(const std::string& path, const StructureOptions& options) {
  return StructureFile(path).read(options);
}

int count_models(const std::string& path) { return StructureFile(path).n_models(); }

}  // namespace espdiff
