// write_ply.cpp: the surface as a PLY file (G. Turk, The PLY Polygon File Format, 1994).
#include "export/write_ply.h"

#include "export/little_endian.h"
#include "io/molecules/write_cif.h"

namespace espdiff {
namespace {

/// Normals of the mapped surface; null where the result has none.
const VtpNumbers* ply_normals(const ExportedResult& result) {
  const VtpNumbers* const normals = find_array(result.files.surface.point_arrays, "normal");
  return normals != nullptr && normals->n_components == 3 ? normals : nullptr;
}

/// Comments as lines that MeshLab reads: it takes 511 bytes at most. A continued line cannot be taken for another
/// comment.
void write_comment(std::ostream& out, const std::string& text) {
  constexpr std::size_t kLongest = 400;
  const char* start = "comment ";
  std::size_t from = 0;
  while (text.size() - from > kLongest) {
    std::size_t to = text.rfind(' ', from + kLongest);
    const bool at_space = to != std::string::npos && to > from + kLongest / 2;
    if (!at_space) {
      to = from + kLongest;
      while ((static_cast<unsigned char>(text[to]) & 0xC0U) == 0x80U) --to;  // inside a character of UTF-8
    }
    out << start << text.substr(from, to - from) << '\n';
    from = to + (at_space ? 1 : 0);
    start = "comment   ";
  }
  out << start << text.substr(from) << '\n';
}

void write_ply_head(std::ostream& out, const ExportedResult& result, const std::vector<SurfaceQuantity>& quantities) {
  out << "ply\nformat binary_little_endian 1.0\n";
  for (const auto& [name, text] : result.notes) write_comment(out, name + ": " + text);
  out << "comment counted_faces " << result.triangles.counted.size() << '\n';
  out << "element vertex " << result.files.surface.positions.size() << '\n';
  std::vector<std::string> names = {"x", "y", "z"};
  if (ply_normals(result) != nullptr) names.insert(names.end(), {"nx", "ny", "nz"});
  names.insert(names.end(), {"source_x", "source_y", "source_z"});
  for (const std::string& name : names) out << "property float " << name << '\n';
  for (const char* name : {"red", "green", "blue"}) out << "property uchar " << name << '\n';
  for (const SurfaceQuantity& quantity : quantities)
    out << "property float " << cif_name(quantity.values->name) << '\n';
  out << "element face " << result.triangles.counted.size() + result.triangles.rest.size()
      << "\nproperty list uchar uint vertex_indices\nend_header\n";
}

void append_position(std::string& bytes, Vec3d p) {
  for (const double x : {p.x, p.y, p.z}) append_f32(bytes, x);
}

void append_faces(std::string& bytes, const std::vector<Triangle>& triangles) {
  for (const Triangle& triangle : triangles) {
    bytes += '\3';
    for (const auto corner : triangle) append_u32(bytes, corner);
  }
}

}  // namespace

void write_ply(std::ostream& out, const ExportedResult& result) {
  const std::vector<SurfaceQuantity> quantities = surface_quantities(result.files);
  const VtpNumbers* const normals = ply_normals(result);
  write_ply_head(out, result, quantities);
  std::vector<std::uint8_t> is_counted(result.source.size(), 0);
  for (const Triangle& triangle : result.triangles.counted) {
    for (const auto corner : triangle) is_counted[corner] = 1;
  }
  std::string bytes;
  for (std::size_t v = 0; v < result.source.size(); ++v) {
    append_position(bytes, result.files.surface.positions[v]);
    for (std::size_t k = 0; normals != nullptr && k < 3; ++k) append_f32(bytes, normals->values[3 * v + k]);
    append_position(bytes, result.source[v]);
    const Rgb rgb = is_counted[v] != 0 ? result.colours[v] : kNoValueColour;
    for (const std::uint8_t channel : {rgb.red, rgb.green, rgb.blue}) bytes += static_cast<char>(channel);
    for (const SurfaceQuantity& quantity : quantities) append_f32(bytes, quantity.values->values[v]);
  }
  append_faces(bytes, result.triangles.counted);
  append_faces(bytes, result.triangles.rest);
  out << bytes;
}

}  // namespace espdiff
