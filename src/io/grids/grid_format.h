// grid_format.h: one format of maps, and the table of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/grids/read_grid.h"

namespace espdiff {

/// A format of maps. Its file, `io/grids/read_NAME.cpp`, has a function `NAME_format()` that returns it.
struct GridFormat {
  std::string name;  ///< for messages: "cube"
  /// Whether a file that begins with `head` has this format. Where recognise() knows it, by its answer `kind`.
  bool (*is)(std::string_view head, FileKind kind);
  /// Reads the content, which no longer is needed. @throws as read_grid()
  Grid (*read)(FileContent file, const GridOptions& options);
  bool has_arrays = false;  ///< a file has several arrays by name, one of which GridOptions choose
};

/// All of them, in the order of the list `grid_formats` in src/CMakeLists.txt, from which the build makes this table.
const std::vector<GridFormat>& grid_formats();

}  // namespace espdiff
