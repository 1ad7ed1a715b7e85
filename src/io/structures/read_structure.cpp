// read_structure.cpp: finds out what a structure file is and hands it to the reader for it.
#include "io/structures/read_structure.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/files/sha256.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/atom_records.h"
#include "io/structures/coordinate_file.h"
#include "io/structures/read_pqr.h"
#include "io/structures/read_unit_cells.h"
#include "io/structures/structure_file.h"
#ifdef ESPDIFF_HAVE_GEMMI
#include "io/structures/pdb_text.h"
#include "io/structures/read_gemmi.h"
#include "io/text/text_cursor.h"
#endif

namespace espdiff {
namespace {

[[noreturn]] void refuse_as_structure(const std::string& path, FileKind kind) {
  std::string remedy = "give a PQR, PDB or mmCIF file";
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

#ifndef ESPDIFF_HAVE_GEMMI
[[noreturn]] void lack_gemmi(const std::string& path, const char* format) {
  throw InputError(
      path + ": this is a " + format +
      " file, and this build lacks the PDB and mmCIF reader; build espdiff with gemmi (Debian: gemmi-dev), "
      "or give a PQR file");
}
#endif

}  // namespace

#ifdef ESPDIFF_HAVE_GEMMI
namespace {

/// The lines that describe biological assemblies.
std::string assembly_remarks(std::string_view text) {
  std::string remarks;
  for (std::size_t begin = text.find("REMARK 350"); begin != std::string_view::npos;
       begin = text.find("REMARK 350", begin + 1)) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    remarks += std::string(text.substr(begin, end - begin)) + '\n';
  }
  return remarks;
}

}  // namespace
#endif

struct StructureFile::Parsed {
  FileContent file;
  bool is_mmcif = false;
  std::vector<AtomModel> models;  // of files with atom records; they point into the content
  /// [model] read when the first of them is asked for.
  std::once_flag cells_are_read;
  std::vector<std::optional<UnitCell>> cells;
};

struct StructureFile::Frames {
  std::unique_ptr<CoordinateFile> file;
  std::shared_ptr<const Molecule> atoms;
  std::string sha256;  // when it was asked for

  const CoordinateFrame& frame(int model) const {
    if (model < 1 || model > file->n_frames())
      throw InputError(file->path() + ": there is no frame " + std::to_string(model - 1) + "; it has " +
                       std::to_string(file->n_frames()) + ", from 0");
    const CoordinateFrame& read = file->frame(model - 1);
    for (std::size_t i = 0; i < read.positions.size(); ++i) check_position(read.positions[i], i, model - 1);
    return read;
  }

  /// A frame that was damaged is an error of its own; the others are good. Not finite is not below the limit.
  void check_position(const Vec3f& p, std::size_t atom, int number) const {
    constexpr float kFarthest_A = 1e6F;
    const auto is_possible = [](float x) { return std::fabs(x) <= kFarthest_A; };
    if (is_possible(p.x) && is_possible(p.y) && is_possible(p.z)) return;
    throw FormatError(file->path(), 0,
                      "frame " + std::to_string(number) + ": atom " + std::to_string(atom) +
                          formatted(" is at (%g, %g, %g) A", static_cast<double>(p.x), static_cast<double>(p.y),
                                    static_cast<double>(p.z)) +
                          ", and coordinates are numbers within 10^6 A; write the frame again, or leave it out");
  }
};

StructureFile::StructureFile(const std::string& path) {
  auto parsed = std::make_unique<Parsed>();
  parsed->file = read_input(path, [&](std::string_view head) {
    const FileKind kind = recognise(head);
    parsed->is_mmcif = kind == FileKind::kMmcif;
    if (!parsed->is_mmcif && kind != FileKind::kAtomRecords) refuse_as_structure(path, kind);
  });
  unify_line_ends(parsed->file.content);
  if (!parsed->is_mmcif) parsed->models = split_models(parsed->file.content, path);
  parsed_ = std::move(parsed);
}

StructureFile::StructureFile(std::unique_ptr<CoordinateFile> frames, std::shared_ptr<const Molecule> atoms)
    : frames_(new Frames{std::move(frames), std::move(atoms), {}}) {}

StructureFile::~StructureFile() = default;

const std::string& StructureFile::sha256() const {
  if (parsed_ != nullptr) return parsed_->file.sha256;
  if (frames_->sha256.empty()) frames_->sha256 = sha256_of_file(frames_->file->path());
  return frames_->sha256;
}

void StructureFile::require_unchanged(const std::string& before) const {
  if (before.empty() || before == sha256()) return;
  throw IoError(parsed_ != nullptr ? parsed_->file.path : frames_->file->path(),
                "the file was changed while it was in use; start again");
}

int StructureFile::n_models() const {
  if (frames_ != nullptr) return frames_->file->n_frames();
  if (!parsed_->is_mmcif) return static_cast<int>(parsed_->models.size());
#ifdef ESPDIFF_HAVE_GEMMI
  return count_mmcif_models(parsed_->file.path, parsed_->file.content);
#else
  lack_gemmi(parsed_->file.path, "mmCIF");
#endif
}

std::optional<UnitCell> StructureFile::unit_cell(int model) const {
  if (frames_ != nullptr) return frames_->frame(model).cell;
  if (parsed_->is_mmcif) return std::nullopt;
  std::call_once(parsed_->cells_are_read,
                 [&] { parsed_->cells = read_unit_cells(parsed_->file.content, parsed_->models, parsed_->file.path); });
  return parsed_->cells.at(static_cast<std::size_t>(model - 1));
}

long StructureFile::line_of(int model, const Residue& residue) const {
#ifdef ESPDIFF_HAVE_GEMMI
  if (frames_ != nullptr || parsed_->is_mmcif) return 0;
  constexpr std::size_t kNumberAt = 22, kWidth = 5;
  std::string number = std::to_string(residue.number);
  if (residue.insertion_code != ' ') number += residue.insertion_code;
  for (const AtomLine& line : pick_model(parsed_->models, model, parsed_->file.path)) {
    if (line.text.size() >= kNumberAt + kWidth && trimmed(line.text.substr(kNumberAt, kWidth)) == number &&
        pdb_chain_name(line) == residue.chain)
      return line.number;
  }
#endif
  return 0;
}

Molecule StructureFile::read(const StructureOptions& options) const {
  if (frames_ != nullptr) {
    Molecule molecule = *frames_->atoms;
    const CoordinateFrame& frame = frames_->frame(options.model);
    for (std::size_t i = 0; i < molecule.size(); ++i) molecule.positions[i] = static_cast<Vec3d>(frame.positions[i]);
    molecule.name = frames_->file->path() + ", frame " + std::to_string(options.model - 1);
    if (!options.assembly.empty())
      throw InputError(frames_->file->path() + ": is a trajectory, which describes no assemblies; leave " +
                       option("assembly") + " out");
    return keep_kinds(molecule, options);
  }
  const auto& [path, text, sha256] = parsed_->file;
#ifdef ESPDIFF_HAVE_GEMMI
  if (parsed_->is_mmcif) return read_mmcif(path, text, options);
#else
  if (parsed_->is_mmcif) lack_gemmi(path, "mmCIF");
#endif
  const AtomModel& model = pick_model(parsed_->models, options.model, path);
  if (looks_like_pqr(model, path)) {
    if (!options.assembly.empty())
      throw InputError(path + ": is a PQR file, which describes no assemblies; leave " + option("assembly") +
                       " out, or give the PDB or mmCIF entry");
    return read_pqr(path, model, options);
  }
#ifdef ESPDIFF_HAVE_GEMMI
  Molecule molecule = read_pdb(path, model, options.assembly.empty() ? std::string() : assembly_remarks(text), options);
  molecule.formulas = formulas_in_pdb(text);
  return molecule;
#else
  lack_gemmi(path, "PDB");
#endif
}

Molecule read_structure(const std::string& path, const StructureOptions& options) {
  return StructureFile(path).read(options);
}

int count_models(const std::string& path) { return StructureFile(path).n_models(); }

}  // namespace espdiff
