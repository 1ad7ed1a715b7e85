// read_grid.cpp: finds out what a map file is and hands it to the reader for it.
#include "io/grids/read_grid.h"

#include <utility>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/grids/read_ccp4.h"
#include "io/grids/read_cube.h"
#include "io/grids/read_dx.h"
#include "io/grids/read_vti.h"

namespace espdiff {
namespace {

[[noreturn]] void refuse_as_grid(const std::string& path, FileKind kind) {
  const bool is_vtk = kind == FileKind::kVtkXml || kind == FileKind::kVtkLegacy;
  throw InputError(path + ": this looks like " + describe(kind) + ", which is not read as a map; " +
                   (is_vtk ? "save it as image data (.vti)" : "give an OpenDX, cube, CCP4 or VTI file"));
}

/// Only VTI files have named arrays.
void refuse_array(const std::string& path, const GridOptions& options) {
  if (options.array.empty()) return;
  throw InputError(path + ": array '" + options.array + "' was asked for, but only VTI files have named arrays");
}

Grid parse_grid(FileContent file, FileKind kind, const GridOptions& options) {
  if (kind == FileKind::kVti) return read_vti(VtkXmlFile(std::move(file), kImageData), options);
  if (kind == FileKind::kCcp4) return read_ccp4(file.path, file.content);
  unify_line_ends(file.content);
  return kind == FileKind::kDx ? read_dx(file.path, file.content) : read_cube(file.path, file.content);
}

}  // namespace

GridFile read_grid_file(const std::string& path, const GridOptions& options) {
  FileKind kind{};
  FileContent file = read_input(path, [&](std::string_view head) {
    kind = recognise(head);
    if (kind == FileKind::kVti) return;
    if (kind != FileKind::kDx && kind != FileKind::kCube && kind != FileKind::kCcp4) refuse_as_grid(path, kind);
    refuse_array(path, options);
  });
  GridFile read{{}, file.sha256};
  read.grid = parse_grid(std::move(file), kind, options);
  if (!options.unit.empty()) take_unit(options.unit, read.grid);
  return read;
}

void take_unit(const std::string& text, Grid& map) {
  const PotentialUnit unit = parse_potential_unit(text);
  if (map.unit != PotentialUnit::kUnknown && unit != map.unit)
    map.contradicting_title = "potential (" + to_string(map.unit) + ")";
  map.unit = unit;
}

Grid read_grid(const std::string& path, const GridOptions& options) {
  return std::move(read_grid_file(path, options).grid);
}

}  // namespace espdiff
