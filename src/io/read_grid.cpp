// read_grid.cpp: finds out what a map file is and hands it to the reader for it.
#include "io/read_grid.h"

#include "base/error.h"
#include "io/file_kind.h"
#include "io/gzip_text.h"
#include "io/read_cube.h"
#include "io/read_dx.h"
#include "io/read_vti.h"

namespace espdiff {
namespace {

[[noreturn]] void refuse(const std::string& path, FileKind kind) {
  std::string remedy = "give an OpenDX, cube or VTI file";
  switch (kind) {
    case FileKind::kCcp4: remedy = "load it in VMD and save it as OpenDX (.dx)"; break;
    case FileKind::kVtkXml:
    case FileKind::kVtkLegacy: remedy = "save it as image data (.vti)"; break;
    case FileKind::kAtomRecords:
    case FileKind::kMmcif:
    case FileKind::kMmjson:
    case FileKind::kBinaryCif:
    case FileKind::kMmtf:
    case FileKind::kMol2:
    case FileKind::kPsf:
    case FileKind::kPrmtop:
    case FileKind::kDcd:
    case FileKind::kNetcdf: remedy = "that is no map; " + remedy; break;
    default: break;
  }
  throw InputError(path + ": this looks like " + describe(kind) + ", which is not read as a map; " + remedy);
}

Grid read_vti_or_refuse(const std::string& path, const GridOptions& options) {
  if (is_gzip_file(path)) {
    throw InputError(path + ": a VTI file packed by gzip; unpack it (gunzip), VTI compresses its values itself");
  }
  return read_vti(path, options);
}

}  // namespace

Grid read_grid(const std::string& path, const GridOptions& options) {
  const FileKind kind = recognise(peek_text_file(path, kRecogniseBytes));
  if (kind == FileKind::kVti) return read_vti_or_refuse(path, options);
  if (kind != FileKind::kDx && kind != FileKind::kCube) refuse(path, kind);
  if (!options.array.empty()) {
    throw InputError(path + ": array '" + options.array + "' was asked for, but only VTI files have named arrays");
  }
  const std::string text = read_text_file(path);
  return kind == FileKind::kDx ? read_dx(path, text) : read_cube(path, text);
}

}  // namespace espdiff
