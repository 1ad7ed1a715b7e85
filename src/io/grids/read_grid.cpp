// read_grid.cpp: finds out what a map file is and hands it to the reader for it.
#include "io/grids/read_grid.h"

#include <utility>

#include "base/error.h"
#include "base/text/joined_words.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/grids/grid_format.h"

namespace espdiff {
namespace {

/// "OpenDX, cube, CCP4 or VTI"
std::string names_of_formats(bool with_arrays_only) {
  std::vector<std::string> names;
  for (const GridFormat& format : grid_formats()) {
    if (!with_arrays_only || format.has_arrays) names.push_back(format.name);
  }
  return joined_words(names);
}

/// The format of a map. @throws InputError for a file that is none
const GridFormat& format_of_map(const std::string& path, std::string_view head) {
  const FileKind kind = recognise(head);
  for (const GridFormat& format : grid_formats()) {
    if (format.is(head, kind)) return format;
  }
  const bool is_vtk = kind == FileKind::kVtkXml || kind == FileKind::kVtkLegacy;
  throw InputError(path + ": this looks like " + describe(kind) + ", which is not read as a map; " +
                   (is_vtk ? "save it as image data (.vti)" : "give an " + names_of_formats(false) + " file"));
}

}  // namespace

GridFile read_grid_file(const std::string& path, const GridOptions& options) {
  const GridFormat* format = nullptr;
  FileContent file = read_input(path, [&](std::string_view head) {
    format = &format_of_map(path, head);
    if (options.array.empty() || format->has_arrays) return;
    throw InputError(path + ": array '" + options.array + "' was asked for, but only " + names_of_formats(true) +
                     " files have named arrays");
  });
  GridFile read{{}, file.sha256};
  read.grid = format->read(std::move(file), options);
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
