// write_glb.cpp: the surface as binary glTF 2.0 (Khronos Group, glTF 2.0 Specification, ISO/IEC 12113:2022).
#include "export/write_glb.h"

#include <algorithm>
#include <cmath>

#include "base/version.h"
#include "export/little_endian.h"
#include "io/molecules/write_cif.h"

namespace espdiff {
namespace {

using GlbJson = nlohmann::ordered_json;

// The specification's numbers of types and targets.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertices = 34962, kIndices = 34963;

/// sRGB to linear light (IEC 61966-2-1), 16 bits.
std::uint16_t linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(light * 65535));
}

/// The binary part, and its description.
class GlbBuffer {
 public:
  GlbJson json = {{"bufferViews", GlbJson::array()}, {"accessors", GlbJson::array()}};
  std::string bytes;

  int add_vectors(const std::vector<Vec3d>& vectors) {
    const std::size_t begin = bytes.size();
    Vec3d low = vectors.empty() ? Vec3d{} : vectors[0], high = low;
    for (const Vec3d& v : vectors) {
      for (const double x : {v.x, v.y, v.z}) append_f32(bytes, x);
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    GlbJson& accessor = add(begin, kVertices, kFloat, "VEC3", vectors.size());
    accessor["min"] = rounded(low);
    accessor["max"] = rounded(high);
    return last();
  }

  int add_colours(const std::vector<Rgb>& colours) {
    const std::size_t begin = bytes.size();
    for (const Rgb& rgb : colours) {
      for (const std::uint8_t channel : {rgb.red, rgb.green, rgb.blue}) append_u16(bytes, linear(channel));
      append_u16(bytes, 65535);  // opaque; keeps each colour at a multiple of 4 bytes
    }
    add(begin, kVertices, kUnsignedShort, "VEC4", colours.size())["normalized"] = true;
    return last();
  }

  int add_numbers(const std::vector<double>& values) {
    const std::size_t begin = bytes.size();
    for (const double value : values) append_f32(bytes, std::isfinite(value) ? value : 0);
    add(begin, kVertices, kFloat, "SCALAR", values.size());
    return last();
  }

  int add_triangles(const std::vector<Triangle>& triangles) {
    const std::size_t begin = bytes.size();
    for (const Triangle& triangle : triangles) {
      for (const auto corner : triangle) append_u32(bytes, corner);
    }
    add(begin, kIndices, kUnsignedInt, "SCALAR", 3 * triangles.size());
    return last();
  }

 private:
  int last() const { return static_cast<int>(json.at("accessors").size()) - 1; }

  /// Bounds in single precision, as the file holds the positions.
  static GlbJson rounded(Vec3d v) {
    GlbJson list = GlbJson::array();
    for (const double x : {v.x, v.y, v.z}) list.push_back(static_cast<double>(static_cast<float>(x)));
    return list;
  }

  GlbJson& add(std::size_t begin, int target, int type, const char* shape, std::size_t n) {
    GlbJson &views = json["bufferViews"], &accessors = json["accessors"];
    views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}, {"target", target}});
    accessors.push_back({{"bufferView", views.size() - 1}, {"componentType", type}, {"count", n}, {"type", shape}});
    return accessors.back();
  }
};

/// "_POTENTIAL_DIFFERENCE"
std::string attribute_name(const std::string& array) {
  std::string name = "_" + cif_name(array);
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name;
}

GlbJson glb_attributes(GlbBuffer& buffer, const ExportedResult& result) {
  const VtpContent& surface = result.files.surface;
  GlbJson attributes = {{"POSITION", buffer.add_vectors(surface.positions)}};
  const VtpNumbers* const normals = find_array(surface.point_arrays, "normal");
  if (normals != nullptr && normals->n_components == 3) {
    std::vector<Vec3d> units;
    for (std::size_t i = 0; i < normals->values.size(); i += 3) {
      const Vec3d n{normals->values[i], normals->values[i + 1], normals->values[i + 2]};
      const double length = norm(n);
      units.push_back(length > 0 && std::isfinite(length) ? (1 / length) * n : Vec3d{0, 0, 1});
    }
    attributes["NORMAL"] = buffer.add_vectors(units);
  }
  for (const SurfaceQuantity& quantity : surface_quantities(result.files))
    attributes[attribute_name(quantity.values->name)] = buffer.add_numbers(quantity.values->values);
  std::vector<double> has_value;
  for (const double value : result.values) has_value.push_back(std::isfinite(value) ? 1 : 0);
  attributes["_HAS_VALUE"] = buffer.add_numbers(has_value);
  return attributes;
}

GlbJson glb_primitives(GlbBuffer& buffer, const ExportedResult& result) {
  const std::vector<Vec3d>& positions = result.files.surface.positions;
  std::vector<Vec3d> to_source(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) to_source[v] = result.source[v] - positions[v];
  const GlbJson grey = glb_attributes(buffer, result);
  GlbJson coloured = grey;
  coloured["COLOR_0"] = buffer.add_colours(result.colours);
  const GlbJson targets = GlbJson::array({{{"POSITION", buffer.add_vectors(to_source)}}});
  GlbJson primitives = GlbJson::array();
  const auto add = [&](const std::vector<Triangle>& triangles, const GlbJson& attributes, int material) {
    if (triangles.empty()) return;
    const GlbJson primitive = {{"attributes", attributes},
                               {"indices", buffer.add_triangles(triangles)},
                               {"material", material},
                               {"targets", targets}};
    primitives.push_back(primitive);
  };
  add(result.triangles.counted, coloured, 0);
  add(result.triangles.rest, grey, 1);
  return primitives;
}

GlbJson materials() {
  const GlbJson dull = {{"metallicFactor", 0}, {"roughnessFactor", 0.9}};
  GlbJson grey = dull;
  grey["baseColorFactor"] = {0.3, 0.3, 0.3, 0.5};
  return {{{"name", "counted"}, {"pbrMetallicRoughness", dull}, {"doubleSided", true}},
          {{"name", "not counted"}, {"pbrMetallicRoughness", grey}, {"alphaMode", "BLEND"}, {"doubleSided", true}}};
}

/// @param type four characters
void write_chunk(std::ostream& out, const std::string& content, const std::string& type) {
  std::string head;
  append_u32(head, static_cast<std::uint32_t>(content.size()));
  out << head << type << content;
}

}  // namespace

void write_glb(std::ostream& out, const ExportedResult& result) {
  GlbBuffer buffer;
  const GlbJson primitives = glb_primitives(buffer, result);
  GlbJson extras = GlbJson::object();
  for (const auto& [name, text] : result.notes) {
    GlbJson& note = extras[name];
    note = note.is_string() ? note.get<std::string>() + "; " + text : text;
  }
  GlbJson json = {
      {"asset", {{"version", "2.0"}, {"generator", std::string("espdiff ") + kVersion}, {"extras", extras}}},
      {"scene", 0},
      {"scenes", GlbJson::array({{{"nodes", {0}}}})},
      {"nodes", GlbJson::array({{{"name", result.title}, {"mesh", 0}}})},
      {"meshes", GlbJson::array({{{"name", result.title},
                                  {"primitives", primitives},
                                  {"weights", {0}},
                                  {"extras", {{"targetNames", {"source"}}}}}})},
      {"materials", materials()},
      {"buffers", GlbJson::array({{{"byteLength", buffer.bytes.size()}}})}};
  json.update(buffer.json);
  std::string text = json.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';
  std::string head = "glTF";
  append_u32(head, 2);
  append_u32(head, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + buffer.bytes.size()));
  out << head;
  write_chunk(out, text, "JSON");
  write_chunk(out, buffer.bytes, std::string("BIN", 4));
}

}  // namespace espdiff
