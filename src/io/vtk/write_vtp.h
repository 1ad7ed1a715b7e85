// write_vtp.h: triangle surfaces with arrays as VTK XML PolyData (.vtp), for ParaView, VTK and espdiff's own viewer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff {

enum class VtpType { kFloat32, kFloat64, kInt32, kUInt8 };

/// An array by name; refers to values that live elsewhere and must outlast the writing.
struct VtpArray {
  std::string name;
  VtpType type = VtpType::kFloat32;
  int n_components = 1;
  std::size_t n_tuples = 0;
  const void* values = nullptr;  ///< [tuple][component]

  VtpArray() = default;
  VtpArray(std::string array_name, const std::vector<float>& v)
      : VtpArray(std::move(array_name), VtpType::kFloat32, 1, v) {}
  VtpArray(std::string array_name, const std::vector<double>& v)
      : VtpArray(std::move(array_name), VtpType::kFloat64, 1, v) {}
  VtpArray(std::string array_name, const std::vector<std::int32_t>& v)
      : VtpArray(std::move(array_name), VtpType::kInt32, 1, v) {}
  VtpArray(std::string array_name, const std::vector<std::uint8_t>& v)
      : VtpArray(std::move(array_name), VtpType::kUInt8, 1, v) {}
  VtpArray(std::string array_name, const std::vector<Vec3f>& v)
      : VtpArray(std::move(array_name), VtpType::kFloat32, 3, v) {}
  VtpArray(std::string array_name, const std::vector<Vec3d>& v)
      : VtpArray(std::move(array_name), VtpType::kFloat64, 3, v) {}

 private:
  template <typename T>
  VtpArray(std::string array_name, VtpType array_type, int components, const std::vector<T>& v)
      : name(std::move(array_name)), type(array_type), n_components(components), n_tuples(v.size()), values(v.data()) {}
};

/// What a .vtp file holds.
struct VtpSurface {
  VtpArray points;  ///< Vec3f or Vec3d, Angstrom
  const std::vector<Triangle>* triangles = nullptr;
  std::vector<VtpArray> point_arrays;                      ///< one tuple a point
  std::vector<VtpArray> cell_arrays;                       ///< one tuple a triangle
  std::vector<std::pair<std::string, std::string>> texts;  ///< field data: name and text, such as a unit
  std::string active_scalars;  ///< point array that viewers colour by at first; may be empty
  std::string active_normals;  ///< point array that viewers light by; may be empty
};

/// Writes VTK XML PolyData, version 1.0: raw appended data, UInt64 headers, the byte order of this machine (named in
/// the file). NaN is written as NaN.
/// @throws Error (internal) when the arrays' lengths or the triangles' indices do not fit. The stream's state is the
/// caller's to
///         check (AtomicFile does).
void write_vtp(std::ostream& out, const VtpSurface& surface);

}  // namespace espdiff
