// read_vtp.h: triangle surfaces with their arrays from VTK XML PolyData, as espdiff writes them and ParaView saves
// them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "io/files/read_input.h"

namespace espdiff {

/// Numbers by tuples: values[n_components * tuple + component].
struct VtpNumbers {
  std::string name;
  int n_components = 1;
  std::vector<double> values;

  std::size_t n_tuples() const { return values.size() / static_cast<std::size_t>(n_components); }
};

/// What a VTP file holds.
struct VtpContent {
  std::vector<Vec3d> positions;  ///< [vertex], at most 10^6 from 0
  std::vector<Triangle> triangles;
  std::vector<VtpNumbers> point_arrays;                    ///< in file order, one tuple a vertex; finite or NaN
  std::vector<VtpNumbers> cell_arrays;                     ///< in file order, one tuple a triangle
  std::vector<std::pair<std::string, std::string>> texts;  ///< field arrays of type String: name, text
};

/// The array of that name; nullptr when there is none.
const VtpNumbers* find_array(const std::vector<VtpNumbers>& arrays, const std::string& name);

/// Reads a VTP file of any encoding that VtkXmlFile reads. Polygons must be triangles; vertex and line cells beside
/// them are left out, as are texts among point arrays.
/// @throws FormatError (damage, sizes that do not agree, corners that name no vertex, positions - those of
/// "source_position"
///         too - beyond 10^6 or not finite, infinite values),
///         InputError (strips, polygons, several pieces, another data set), IoError, MemoryError
VtpContent read_vtp(const std::string& path);
/// The same of what was read before.
VtpContent read_vtp(FileContent file);

}  // namespace espdiff
