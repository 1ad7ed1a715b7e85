// read_structure.cpp: finds out what a structure file is and hands it to the reader for it.
#include "io/read_structure.h"

#include <utility>

#include "base/error.h"
#include "io/file_kind.h"
#include "io/gzip_text.h"
#include "io/read_pqr.h"
#ifdef ESPDIFF_HAVE_GEMMI
#include "io/read_gemmi.h"
#endif

namespace espdiff {
namespace {

[[noreturn]] void refuse(const std::string& path, FileKind kind) {
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
      remedy = "load topology and coordinates in VMD and use espdiff there, or write a PQR from VMD and give that";
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

StructureFile::StructureFile(std::string path) : path_(std::move(path)) {
  const FileKind kind = recognise(peek_text_file(path_, kRecogniseBytes));
  is_mmcif_ = kind == FileKind::kMmcif;
  if (!is_mmcif_ && kind != FileKind::kAtomRecords) refuse(path_, kind);
  text_ = read_text_file(path_);
  if (!is_mmcif_) models_ = split_models(text_, path_);
}

int StructureFile::n_models() const {
  if (!is_mmcif_) return static_cast<int>(models_.size());
#ifdef ESPDIFF_HAVE_GEMMI
  return count_mmcif_models(path_, text_);
#else
  lack_gemmi(path_, "mmCIF");
#endif
}

Molecule StructureFile::read(const StructureOptions& options) const {
#ifdef ESPDIFF_HAVE_GEMMI
  if (is_mmcif_) return read_mmcif(path_, text_, options);
#else
  if (is_mmcif_) lack_gemmi(path_, "mmCIF");
#endif
  const AtomModel& model = pick_model(models_, options.model, path_);
  if (looks_like_pqr(model, path_)) return read_pqr(path_, model, options);
#ifdef ESPDIFF_HAVE_GEMMI
  return read_pdb(path_, model, options);
#else
  lack_gemmi(path_, "PDB");
#endif
}

Molecule read_structure(const std::string& path, const StructureOptions& options) {
  return StructureFile(path).read(options);
}

int count_models(const std::string& path) { return StructureFile(path).n_models(); }

}  // namespace espdiff
