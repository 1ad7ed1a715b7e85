// read_vtp.cpp: points, triangles and arrays of a VTP file, each of the length that the head says.
#include "io/vtk/read_vtp.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "io/text/text_cursor.h"
#include "io/vtk/vtk_xml.h"

namespace espdiff {
namespace {

/// Numbers of cells of each kind, in the order of cell arrays.
struct Counts {
  std::size_t points = 0, before = 0, triangles = 0;  // before: vertex and line cells, whose entries come first
};

/// An attribute that counts something; 0 where it is absent.
std::size_t count(const VtkXmlFile& file, const XmlElement& piece, const char* name) {
  if (piece.attribute(name) == nullptr) return 0;
  const long long n = file.integers(piece, name, 1).front();
  if (n < 0) file.fail(piece, std::string(name) + " is " + std::to_string(n) + ", but 0 or more was expected");
  return static_cast<std::size_t>(n);
}

const XmlElement& only_piece(const VtkXmlFile& file) {
  const XmlElement* piece = nullptr;
  for (const XmlElement& child : file.data_set().children) {
    if (child.name != "Piece") continue;
    if (piece != nullptr) throw InputError(file.path() + ": has several pieces; save the surface as one");
    piece = &child;
  }
  if (piece == nullptr) file.fail(file.data_set(), "the surface has no <Piece>");
  return *piece;
}

Counts read_counts(const VtkXmlFile& file, const XmlElement& piece) {
  if (count(file, piece, "NumberOfStrips") > 0)
    throw InputError(file.path() + ": has triangle strips; save the surface as triangles");
  Counts counts;
  file.require(piece, "NumberOfPoints");
  counts.points = count(file, piece, "NumberOfPoints");
  counts.before = count(file, piece, "NumberOfVerts") + count(file, piece, "NumberOfLines");
  counts.triangles = count(file, piece, "NumberOfPolys");
  return counts;
}

const XmlElement* array_named(const XmlElement& element, const std::string& name) {
  for (const XmlElement& child : element.children) {
    const std::string* const found = child.attribute("Name");
    if (child.name == "DataArray" && found != nullptr && *found == name) return &child;
  }
  return nullptr;
}

constexpr double kMostVertex_A = 1e6;

void require_near(const VtkXmlFile& file, const XmlElement& array, std::size_t vertex, double value) {
  if (!(std::fabs(value) <= kMostVertex_A))
    file.fail(array, "vertex " + std::to_string(vertex) +
                         formatted(" has the coordinate %g; at most 10^6 Angstrom were expected", value));
}

std::vector<Vec3d> read_positions(const VtkXmlFile& file, const XmlElement& piece, std::size_t n_points) {
  const XmlElement* const points = piece.child("Points");
  const XmlElement* const array = points != nullptr ? points->child("DataArray") : nullptr;
  if (array == nullptr) file.fail(piece, "the surface has no points");
  if (file.n_components(*array) != 3) file.fail(*array, "the points have no three components");
  std::vector<Vec3d> positions;
  file.read_values(*array, 3 * n_points, [&](std::size_t i, double value) {
    require_near(file, *array, i / 3, value);
    if (i % 3 == 0) positions.emplace_back();
    positions.back()[static_cast<int>(i % 3)] = value;
  });
  return positions;
}

std::vector<Triangle> read_triangles(const VtkXmlFile& file, const XmlElement& piece, const Counts& counts) {
  std::vector<Triangle> triangles;
  if (counts.triangles == 0) return triangles;
  const XmlElement* const polygons = piece.child("Polys");
  const XmlElement* const corners = polygons != nullptr ? array_named(*polygons, "connectivity") : nullptr;
  const XmlElement* const offsets = polygons != nullptr ? array_named(*polygons, "offsets") : nullptr;
  if (corners == nullptr || offsets == nullptr)
    file.fail(piece, "the polygons have no arrays connectivity and offsets");
  file.read_values(*offsets, counts.triangles, [&](std::size_t i, double end) {
    if (end == static_cast<double>(3 * (i + 1))) return;
    throw FormatError(file.path(), offsets->line,
                      "polygon " + std::to_string(i) + " is no triangle; espdiff draws triangles only");
  });
  file.read_values(*corners, 3 * counts.triangles, [&](std::size_t i, double vertex) {
    if (!(vertex >= 0) || vertex >= static_cast<double>(counts.points) || vertex != std::floor(vertex)) {
      throw FormatError(file.path(), corners->line,
                        "a triangle refers to vertex " + formatted("%.0f", vertex) + " of " +
                            std::to_string(counts.points) + "; write the file again");
    }
    if (i % 3 == 0) triangles.emplace_back();
    triangles.back()[i % 3] = static_cast<std::uint32_t>(vertex);
  });
  return triangles;
}

/// Numeric arrays of an element, after `n_before` tuples that are skipped.
std::vector<VtpNumbers> read_arrays(const VtkXmlFile& file, const XmlElement* element, std::size_t n_before,
                                    std::size_t n) {
  std::vector<VtpNumbers> arrays;
  if (element == nullptr) return arrays;
  for (const XmlElement& array : element->children) {
    if (array.name != "DataArray") continue;
    VtpNumbers numbers;
    numbers.name = file.require(array, "Name");
    if (find_array(arrays, numbers.name) != nullptr)
      file.fail(array, "there are two arrays named " + in_quotes(numbers.name));
    numbers.n_components = file.n_components(array);
    const auto width = static_cast<std::size_t>(numbers.n_components);
    require_memory(static_cast<double>(width * n) * sizeof(double), file.path());
    const bool has_positions = numbers.name == "source_position";
    file.read_values(array, width * (n_before + n), [&](std::size_t i, double value) {
      if (has_positions) require_near(file, array, i / width, value);
      if (std::isinf(value))
        file.fail(array, "array " + in_quotes(numbers.name) + " has an infinite value; numbers or nan were expected");
      if (i >= width * n_before) numbers.values.push_back(value);
    });
    arrays.push_back(std::move(numbers));
  }
  return arrays;
}

std::vector<std::pair<std::string, std::string>> read_texts(const VtkXmlFile& file) {
  std::vector<std::pair<std::string, std::string>> texts;
  const XmlElement* const fields = file.data_set().child("FieldData");
  if (fields == nullptr) return texts;
  for (const XmlElement& array : fields->children) {
    const std::string* const type = array.attribute("type");
    const std::string* const name = array.attribute("Name");
    if (type != nullptr && *type == "String" && name != nullptr) texts.emplace_back(*name, file.read_text(array));
  }
  return texts;
}

}  // namespace

const VtpNumbers* find_array(const std::vector<VtpNumbers>& arrays, const std::string& name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const VtpNumbers& a) { return a.name == name; });
  return found != arrays.end() ? &*found : nullptr;
}

VtpContent read_vtp(const std::string& path) { return read_vtp(read_input(path)); }

VtpContent read_vtp(FileContent content_of_file) {
  const std::string path = content_of_file.path;
  try {
    const VtkXmlFile file(std::move(content_of_file), "PolyData");
    const XmlElement& piece = only_piece(file);
    const Counts counts = read_counts(file, piece);
    VtpContent content;
    content.positions = read_positions(file, piece, counts.points);
    content.triangles = read_triangles(file, piece, counts);
    content.point_arrays = read_arrays(file, piece.child("PointData"), 0, counts.points);
    content.cell_arrays = read_arrays(file, piece.child("CellData"), counts.before, counts.triangles);
    content.texts = read_texts(file);
    return content;
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": the surface does not fit into memory");
  }
}

}  // namespace espdiff
