// read_vti.cpp: places the lattice of a VTI file and collects one point array of its pieces.
#include "io/grids/read_vti.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "io/grids/grid_checks.h"
#include "io/grids/grid_format.h"
#include "io/grids/read_dx.h"
#include "io/text/text_cursor.h"
#include "io/vtk/vtk_xml.h"

namespace espdiff {
namespace {

/// First and last index along each axis.
struct Extent {
  std::array<long long, 3> first{}, last{};

  std::array<long long, 3> counts() const {
    return {last[0] - first[0] + 1, last[1] - first[1] + 1, last[2] - first[2] + 1};
  }
};

Extent read_extent(const VtkXmlFile& file, const XmlElement& element, const char* name) {
  const std::vector<long long> bounds = file.integers(element, name, 6);
  Extent extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent.first[axis] = bounds[2 * axis];
    extent.last[axis] = bounds[2 * axis + 1];
  }
  return extent;
}

/// Point (i, j, k) of the whole extent lies at origin + direction * (spacing * (extent start + ijk)).
Lattice read_lattice(const VtkXmlFile& file, const Extent& whole) {
  const XmlElement& image = file.data_set();
  Lattice lattice;
  lattice.size = check_counts(whole.counts(), file.path(), image.line);
  const std::vector<double> origin = file.numbers(image, "Origin", 3), spacing = file.numbers(image, "Spacing", 3);
  std::vector<double> direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (image.attribute("Direction") != nullptr) direction = file.numbers(image, "Direction", 9);
  lattice.origin = {origin[0], origin[1], origin[2]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d& step = lattice.step[axis];
    for (int row = 0; row < 3; ++row) step[row] = spacing[axis] * direction[3 * static_cast<std::size_t>(row) + axis];
    lattice.origin += static_cast<double>(whole.first[axis]) * step;
  }
  check_axes(lattice, file.path(), image.line);
  return lattice;
}

std::vector<const XmlElement*> pieces_of(const VtkXmlFile& file) {
  std::vector<const XmlElement*> pieces;
  for (const XmlElement& child : file.data_set().children) {
    if (child.name == "Piece") pieces.push_back(&child);
  }
  if (pieces.empty()) file.fail(file.data_set(), "the image has no <Piece>");
  return pieces;
}

/// Pieces share points at their borders, so cells are counted.
void check_pieces(const VtkXmlFile& file, const std::vector<const XmlElement*>& pieces, const Extent& whole) {
  long long n_cells = 0;
  for (const XmlElement* piece : pieces) {
    const Extent extent = read_extent(file, *piece, "Extent");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (extent.first[axis] < whole.first[axis] || extent.last[axis] > whole.last[axis] ||
          extent.last[axis] <= extent.first[axis])
        file.fail(*piece,
                  "the extent " + in_quotes(file.require(*piece, "Extent")) + " of a piece is no part of WholeExtent");
    }
    const auto counts = extent.counts();
    n_cells += (counts[0] - 1) * (counts[1] - 1) * (counts[2] - 1);
  }
  const auto size = whole.counts();
  const long long expected = (size[0] - 1) * (size[1] - 1) * (size[2] - 1);
  if (n_cells == expected) return;
  throw FormatError(file.path(), 0,
                    "the pieces of the VTI file have " + std::to_string(n_cells) + " cells, but WholeExtent has " +
                        std::to_string(expected) + "; they must cover it exactly");
}

std::vector<const XmlElement*> point_arrays(const XmlElement& piece) {
  std::vector<const XmlElement*> arrays;
  const XmlElement* const points = piece.child("PointData");
  if (points == nullptr) return arrays;
  for (const XmlElement& child : points->children) {
    if (child.name == "DataArray") arrays.push_back(&child);
  }
  return arrays;
}

std::string name_of(const XmlElement& array) {
  const std::string* const name = array.attribute("Name");
  return name != nullptr ? *name : std::string();
}

std::string list_names(const std::vector<const XmlElement*>& arrays) {
  constexpr std::size_t kMostShown = 20;
  std::string names;
  for (std::size_t i = 0; i < arrays.size() && i < kMostShown; ++i)
    names += (i > 0 ? ", " : "") + in_quotes(name_of(*arrays[i]));
  return arrays.size() > kMostShown ? names + ", ..." : names;
}

const XmlElement* find_array(const std::vector<const XmlElement*>& arrays, const std::string& name) {
  const auto found =
      std::find_if(arrays.begin(), arrays.end(), [&](const XmlElement* a) { return name_of(*a) == name; });
  return found != arrays.end() ? *found : nullptr;
}

/// The array asked for, otherwise the one that is marked as scalars, otherwise the only one.
const XmlElement& choose_array(const VtkXmlFile& file, const XmlElement& piece, const std::string& wanted) {
  const std::vector<const XmlElement*> arrays = point_arrays(piece);
  if (arrays.empty()) {
    const bool has_cells = piece.child("CellData") != nullptr && !piece.child("CellData")->children.empty();
    throw InputError(file.path() + ": has no point arrays" + (has_cells ? ", only cell arrays" : "") +
                     "; save the map as point data");
  }
  const XmlElement* array = nullptr;
  if (!wanted.empty()) {
    array = find_array(arrays, wanted);
    if (array == nullptr)
      throw InputError(file.path() + ": has no point array " + in_quotes(wanted) + "; it has " + list_names(arrays));
  } else {
    const std::string* const active = piece.child("PointData")->attribute("Scalars");
    if (active != nullptr) array = find_array(arrays, *active);
    if (array == nullptr && arrays.size() == 1) array = arrays.front();
  }
  if (array == nullptr) {
    throw InputError(file.path() + ": no point array is marked as scalars; choose one by name (point arrays: " +
                     list_names(arrays) + ")");
  }
  const int n_components = file.n_components(*array);
  if (n_components != 1) {
    throw InputError(file.path() + ": point " + array_in_words(*array) + " has " + std::to_string(n_components) +
                     " components; one number a point was expected");
  }
  return *array;
}

void read_piece(const VtkXmlFile& file, const XmlElement& piece, const XmlElement& array, const Extent& whole,
                Grid& grid) {
  const Extent extent = read_extent(file, piece, "Extent");
  const auto counts = extent.counts();
  const std::array<long long, 3> at = {extent.first[0] - whole.first[0], extent.first[1] - whole.first[1],
                                       extent.first[2] - whole.first[2]};
  const auto& size = grid.lattice.size;
  const auto n = static_cast<std::size_t>(counts[0] * counts[1] * counts[2]);
  const bool is_whole = n == grid.lattice.n_points();
  file.read_values(array, n, [&](std::size_t i, double value) {
    const auto index = static_cast<long long>(i);
    const std::size_t point =
        is_whole ? i
                 : static_cast<std::size_t>(at[0] + index % counts[0] +
                                            size[0] * (at[1] + index / counts[0] % counts[1] +
                                                       size[1] * (at[2] + index / (counts[0] * counts[1]))));
    const auto number = static_cast<float>(value);
    if (!std::isfinite(number))
      throw FormatError(
          file.path(), 0,
          "value " + std::to_string(i + 1) + " is " + formatted(value) + "; a finite number was expected");
    grid.values[point] = number;
  });
}

/// The field array that write_vti() writes.
PotentialUnit read_unit(const VtkXmlFile& file) {
  const XmlElement* const fields = file.data_set().child("FieldData");
  if (fields == nullptr) return PotentialUnit::kUnknown;
  for (const XmlElement& array : fields->children) {
    if (array.name == "Array" && name_of(array) == "unit" && file.require(array, "type") == "String")
      return find_potential_unit("potential (" + file.read_text(array) + ")");
  }
  return PotentialUnit::kUnknown;
}

}  // namespace

Grid read_vti(const VtkXmlFile& file, const GridOptions& options) {
  const std::string& path = file.path();
  try {
    const Extent whole = read_extent(file, file.data_set(), "WholeExtent");
    Grid grid;
    grid.name = path;
    grid.lattice = read_lattice(file, whole);
    // Packed, a value takes almost nothing: a float of zlib's, a 1032nd of its bytes; in ascii, a digit and a blank.
    constexpr std::size_t kLeastPerPacked = 1032;
    check_size_promise(grid.lattice.n_points(), grid.lattice.n_points() / kLeastPerPacked, file.n_bytes(), path, 0);
    const std::vector<const XmlElement*> pieces = pieces_of(file);
    check_pieces(file, pieces, whole);
    const XmlElement& array = choose_array(file, *pieces.front(), options.array);

    require_memory(static_cast<double>(grid.lattice.n_points()) * sizeof(float), path);
    allocate_values(grid);
    std::fill(grid.values.begin(), grid.values.end(), std::numeric_limits<float>::quiet_NaN());
    for (const XmlElement* piece : pieces) {
      const XmlElement* const same = find_array(point_arrays(*piece), name_of(array));
      if (same == nullptr || file.n_components(*same) != 1)
        file.fail(*piece, "a piece has no point " + array_in_words(array) + " with one number a point");
      read_piece(file, *piece, *same, whole, grid);
    }
    const auto hole = std::find_if(grid.values.begin(), grid.values.end(), [](float v) { return std::isnan(v); });
    if (hole != grid.values.end()) file.fail(file.data_set(), "the pieces of the VTI file overlap and leave a gap");
    grid.unit = read_unit(file);
    if (grid.unit == PotentialUnit::kUnknown) grid.contradicting_title = title_of_other_quantity(name_of(array));
    return grid;
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": the VTI map does not fit into memory; crop or coarsen it");
  }
}

std::vector<std::string> list_vti_scalars(const VtkXmlFile& file) {
  std::vector<std::string> names;
  for (const XmlElement* array : point_arrays(*pieces_of(file).front())) {
    if (file.n_components(*array) == 1) names.push_back(name_of(*array));
  }
  return names;
}

GridFormat vti_format() {
  return {"VTI", [](std::string_view, FileKind kind) { return kind == FileKind::kVti; },
          [](FileContent file, const GridOptions& options) {
            return read_vti(VtkXmlFile(std::move(file), kImageData), options);
          },
          true};
}

}  // namespace espdiff
