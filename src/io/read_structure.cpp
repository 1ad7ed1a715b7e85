// read_structure.cpp: finds out what a structure file is and hands it to the reader for it.
#include "io/read_structure.h"

#include <vector>

#include "base/error.h"
#include "io/atom_records.h"
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

Molecule read_atom_records(const std::string& path, const StructureOptions& options) {
  const std::string text = read_text_file(path);
  const std::vector<AtomModel> models = split_models(text, path);
  const AtomModel& model = pick_model(models, options.model, path);
  if (looks_like_pqr(model, path)) return read_pqr(path, model, options);
#ifdef ESPDIFF_HAVE_GEMMI
  return read_pdb(path, model, options);
#else
  lack_gemmi(path, "PDB");
#endif
}

}  // namespace

Molecule read_structure(const std::string& path, const StructureOptions& options) {
  const FileKind kind = recognise(peek_text_file(path, kRecogniseBytes));
  if (kind == FileKind::kAtomRecords) return read_atom_records(path, options);
  if (kind != FileKind::kMmcif) refuse(path, kind);
#ifdef ESPDIFF_HAVE_GEMMI
  return read_mmcif(path, read_text_file(path), options);
#else
  lack_gemmi(path, "mmCIF");
#endif
}

int count_models(const std::string& path) {
  const FileKind kind = recognise(peek_text_file(path, kRecogniseBytes));
  if (kind == FileKind::kAtomRecords) return static_cast<int>(split_models(read_text_file(path), path).size());
  if (kind != FileKind::kMmcif) refuse(path, kind);
#ifdef ESPDIFF_HAVE_GEMMI
  return count_mmcif_models(path, read_text_file(path));
#else
  lack_gemmi(path, "mmCIF");
#endif
}

}  // namespace espdiff
