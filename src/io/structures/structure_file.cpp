// structure_file.cpp: finds out what a structure file is and hands it to the reader for it.
#include "io/structures/structure_file.h"

#include <utility>

#include "base/error.h"
#include "base/text/joined_words.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/structures/frame_models.h"
#include "io/structures/structure_format.h"

namespace espdiff {
namespace {

[[noreturn]] void refuse_as_structure(const std::string& path, FileKind kind) {
  Message remedy("give a " + structure_format_names() + " file");
  switch (kind) {
    case FileKind::kDx:
    case FileKind::kCube:
    case FileKind::kVti:
    case FileKind::kVtkXml:
    case FileKind::kVtkLegacy:
    case FileKind::kCcp4: remedy = Message("that is no structure; ") + remedy; break;
    case FileKind::kPsf:
    case FileKind::kPrmtop:
      remedy = "give the structure or restart of its atoms, and this as " + option("topology");
      break;
    case FileKind::kSdf: remedy = "`obabel LIGAND.sdf -O LIGAND.mol2` writes it with charges; give that"; break;
    case FileKind::kTpr:
    case FileKind::kGromacsTopology: remedy = kGromacsRemedy; break;
    case FileKind::kDcd:
      remedy =
          "the command line's trajectory takes a topology and it; otherwise load both in VMD and use espdiff there, or "
          "write a PQR from VMD and give that";
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

}  // namespace

std::string structure_format_names() {
  std::vector<std::string> names;
  for (const StructureFormat& format : structure_formats()) names.push_back(format.name);
  return joined_words(names);
}

StructureFile::StructureFile(const std::string& path) : path_(path) {
  const StructureFormat* format = nullptr;
  FileContent file = read_input(path, [&](std::string_view head) { format = &format_of_structure(path, head); });
  sha256_ = file.sha256;
  models_ = format->open(std::move(file));
}

StructureFile::StructureFile(std::unique_ptr<CoordinateFile> frames, std::shared_ptr<const Molecule> atoms)
    : path_(frames->path()), models_(std::make_unique<FrameModels>(std::move(frames), std::move(atoms))) {}

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
bool StructureFile::needs_atoms() const { return models_->needs_atoms(); }
Molecule StructureFile::read(const StructureOptions& options) const { return models_->read(options); }

Molecule StructureFile::read_with(const Molecule& atoms, const StructureOptions& options) const {
  return models_->read_with(atoms, options);
}

std::size_t StructureFile::n_atoms(int model) const {
  return needs_atoms() ? models_->n_atoms() : read({model, true, true, {}}).size();
}

Molecule read_structure(const std::string& path, const StructureOptions& options) {
  return StructureFile(path).read(options);
}

int count_models(const std::string& path) { return StructureFile(path).n_models(); }

}  // namespace espdiff
