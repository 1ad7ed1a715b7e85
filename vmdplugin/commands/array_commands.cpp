// array_commands.cpp: surfaces as arrays, for scripts of other languages that reach us through Tcl.
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "vmdplugin/objects/vertex_quantity.h"
#include "vmdplugin/values/tcl_values.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/file/ensemble_file.h"
#include "vmdplugin/objects/ensemble_object.h"
#endif

namespace espdiff::vmdplugin {
namespace {

template <typename T>
constexpr const char* kType = nullptr;
template <>
constexpr const char* kType<float> = "f4";
template <>
constexpr const char* kType<double> = "f8";
template <>
constexpr const char* kType<std::uint32_t> = "u4";
template <>
constexpr const char* kType<std::int32_t> = "i4";
template <>
constexpr const char* kType<std::uint8_t> = "u1";

/// {TYPE COLUMNS HEXADECIMAL}: NumPy's name of the type, and the bytes in the machine's order. Tcl passes texts on to
/// other languages unharmed, but not bytes.
template <typename T>
Tcl_Obj* array(const T* values, std::size_t n, int columns) {
  constexpr const char* kDigits = "0123456789abcdef";
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values);
  std::string digits(2 * n * sizeof(T), '0');
  for (std::size_t i = 0; i < n * sizeof(T); ++i) {
    digits[2 * i] = kDigits[bytes[i] >> 4U];
    digits[2 * i + 1] = kDigits[bytes[i] & 15U];
  }
  return to_list({to_obj(kType<T>), to_obj(columns), to_obj(digits)});
}

template <typename T>
Tcl_Obj* array(const std::vector<T>& v) {
  return array(v.data(), v.size(), 1);
}
Tcl_Obj* array(const std::vector<Vec3d>& v) {
  return array(reinterpret_cast<const double*>(v.data()), 3 * v.size(), 3);
}
Tcl_Obj* array(const std::vector<Vec3f>& v) { return array(reinterpret_cast<const float*>(v.data()), 3 * v.size(), 3); }
Tcl_Obj* array(const std::vector<Triangle>& v) {
  return array(reinterpret_cast<const std::uint32_t*>(v.data()), 3 * v.size(), 3);
}

/// @returns null for another name
Tcl_Obj* comparison_array(const MappedSurface& s, const std::string& name) {
  if (name == "positions") return array(s.positions);
  if (name == "source_positions") return array(s.source_positions);
  if (name == "normals") return array(s.normals);
  if (name == "source_normals") return array(s.source_normals);
  if (name == "triangles") return array(s.triangles);
  if (name == "residue_index") return array(s.residue);
  if (name == "corrupt") return array(s.corrupt);
  if (name == "unmatched") return array(s.unmatched);
  if (name == "why") return array(s.why);
  if (name == "slip") return array(s.slip);
  if (name == "source_potential") return array(s.potential_source);
  if (name == "target_potential") return array(s.potential_target);
  return nullptr;
}

/// @returns null for another name
Tcl_Obj* surface_array(const SurfaceResult& r, const std::string& name) {
  if (name == "positions") return array(r.positions);
  if (name == "normals") return array(r.mesh.normals);
  if (name == "triangles") return array(r.mesh.triangles);
  if (name == "residue_index") return array(r.residue);
  if (name == "potential") return array(r.potential);
  return nullptr;
}

/// @returns null for another name, and another kind of object
Tcl_Obj* ensemble_array(const Object& object, const std::string& name) {
#ifdef ESPDIFF_HAVE_HDF5
  const auto* const ensemble = dynamic_cast<const EnsembleObject*>(&object);
  if (ensemble == nullptr || ensemble->answer.result == nullptr) return nullptr;
  const TemplateSurface& surface = ensemble->answer.file->surface();
  if (name == "positions") return array(surface.positions);
  if (name == "normals") return array(surface.normals);
  if (name == "triangles") return array(surface.triangles);
  if (name == "residue_index") return array(surface.residue);
  const SurfaceTest& test = ensemble->answer.result->test;
  if (name == "difference") return array(test.vertices.difference);
  if (name == "low") return array(test.vertices.low);
  if (name == "high") return array(test.vertices.high);
  if (name == "p") return array(test.vertices.p);
  if (name == "p_family_wise" && ensemble->answer.result->compares)
    return array(ensemble->answer.result->family_wise());
#else
  static_cast<void>(object);
  static_cast<void>(name);
#endif
  return nullptr;
}

Tcl_Obj* array_of(const Call& call) {
  const std::string handle = call.text(0), name = call.text(1);
  const auto object = call.handles.find(handle);
  require_done(handle, *object);
  Tcl_Obj* found = nullptr;
  if (const auto* comparison = dynamic_cast<const ComparisonObject*>(object.get()))
    found = comparison_array(comparison->result.surface, name);
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get()))
    found = surface_array(surface->result, name);
  if (found == nullptr) found = ensemble_array(*object, name);
  if (found != nullptr) return found;
  const VertexQuantity quantity = vertex_quantity(handle, *object, name);
  return array(quantity.values);
}

}  // namespace

std::vector<Command> array_commands() { return {{"array", 2, 2, "handle name", array_of}}; }

}  // namespace espdiff::vmdplugin
