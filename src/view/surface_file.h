// surface_file.h: reads the mapped surface that `espdiff compare` writes, as far as drawing needs it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A surface with the one array that it is coloured by.
struct SurfaceFile {
  std::vector<Vec3d> positions;  ///< [vertex], Angstrom
  std::vector<Vec3f> normals;    ///< [vertex], unit, outward
  std::vector<Triangle> triangles;
  std::vector<float> values;          ///< [vertex] the array asked for; NaN where it has no value
  std::vector<float> displacement;    ///< [vertex], Angstrom; empty when the file has none
  std::vector<std::uint8_t> corrupt;  ///< [triangle]; empty when the file has none
  std::string potential_unit;         ///< field data `potential_unit`; empty when the file has none
};

/// Reads a VTK XML PolyData file (.vtp).
/// @param array point array to colour by, such as "potential_difference". `sign_change` has no value (NaN) where
///              `potential_difference` has none
/// @throws IoError (missing, a directory), FormatError (not a .vtp file, truncated, no triangles), InputError (no such
/// array: names those
///         that there are)
SurfaceFile read_surface_file(const std::string& path, const std::string& array);

}  // namespace espdiff
