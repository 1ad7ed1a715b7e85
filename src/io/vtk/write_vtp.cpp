// write_vtp.cpp: the XML head of a .vtp file, then its arrays as they lie in memory.
#include "io/vtk/write_vtp.h"

#include <cstring>

#include "base/error.h"
#include "io/vtk/vtk_encoding.h"

namespace espdiff {
namespace {

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double), "vectors lie without gaps");

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorClass::kInternal, "surface file: " + message); }

std::size_t size_of(VtpType type) {
  switch (type) {
    case VtpType::kFloat32: return sizeof(float);
    case VtpType::kFloat64: return sizeof(double);
    case VtpType::kInt32: return sizeof(std::int32_t);
    case VtpType::kUInt8: break;
  }
  return sizeof(std::uint8_t);
}

const char* name_of(VtpType type) {
  switch (type) {
    case VtpType::kFloat32: return "Float32";
    case VtpType::kFloat64: return "Float64";
    case VtpType::kInt32: return "Int32";
    case VtpType::kUInt8: break;
  }
  return "UInt8";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  }
  return result;
}

/// Bytes of the appended section, and where they start in it.
class AppendedData {
 public:
  /// Takes a block; returns the offset that the XML head names.
  std::uint64_t add(const void* values, std::size_t n_bytes) {
    const std::uint64_t offset = n_bytes_;
    blocks_.emplace_back(values, n_bytes);
    n_bytes_ += sizeof(std::uint64_t) + n_bytes;
    return offset;
  }

  void write(std::ostream& out) const {
    for (const auto& [values, n_bytes] : blocks_) {
      const std::uint64_t header = n_bytes;
      out.write(reinterpret_cast<const char*>(&header), sizeof header);
      if (n_bytes > 0) out.write(static_cast<const char*>(values), static_cast<std::streamsize>(n_bytes));
    }
  }

 private:
  std::vector<std::pair<const void*, std::size_t>> blocks_;
  std::uint64_t n_bytes_ = 0;
};

void write_array(std::ostream& out, const std::string& name, const char* type, int n_components, std::uint64_t offset) {
  out << "        <DataArray type=\"" << type << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
      << n_components << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
}

void write_arrays(std::ostream& out, const std::vector<VtpArray>& arrays, AppendedData& appended) {
  for (const VtpArray& a : arrays) {
    const std::size_t n_bytes = a.n_tuples * static_cast<std::size_t>(a.n_components) * size_of(a.type);
    write_array(out, a.name, name_of(a.type), a.n_components, appended.add(a.values, n_bytes));
  }
}

/// Texts are arrays of character codes that end with 0.
void write_texts(std::ostream& out, const std::vector<std::pair<std::string, std::string>>& texts) {
  if (texts.empty()) return;
  out << "    <FieldData>\n";
  for (const auto& [name, text] : texts) {
    out << "      <Array type=\"String\" Name=\"" << escaped(name) << "\" NumberOfTuples=\"1\" format=\"ascii\">";
    for (const char c : text) out << static_cast<int>(static_cast<unsigned char>(c)) << ' ';
    out << "0</Array>\n";
  }
  out << "    </FieldData>\n";
}

void check_lengths(const std::vector<VtpArray>& arrays, std::size_t n, const char* what) {
  for (const VtpArray& a : arrays) {
    if (a.n_tuples == n) continue;
    fail("the array " + a.name + " has " + std::to_string(a.n_tuples) + " entries for " + std::to_string(n) + " " +
         what);
  }
}

void check(const VtpSurface& surface) {
  const std::size_t n_points = surface.points.n_tuples;
  const bool is_real = surface.points.type == VtpType::kFloat32 || surface.points.type == VtpType::kFloat64;
  if (surface.points.n_components != 3 || !is_real) fail("points are not vectors of three real numbers");
  if (surface.triangles == nullptr) fail("no triangles were given");
  check_lengths(surface.point_arrays, n_points, "points");
  check_lengths(surface.cell_arrays, surface.triangles->size(), "triangles");
  for (const Triangle& triangle : *surface.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= n_points)
        fail("a triangle names vertex " + std::to_string(vertex) + " of " + std::to_string(n_points));
    }
  }
}

std::string active(const std::string& attribute, const std::string& name) {
  return name.empty() ? "" : " " + attribute + "=\"" + escaped(name) + "\"";
}

}  // namespace

void write_vtp(std::ostream& out, const VtpSurface& surface) {
  check(surface);
  std::vector<std::int64_t> connectivity, offsets;
  for (const Triangle& triangle : *surface.triangles) {
    connectivity.insert(connectivity.end(), triangle.begin(), triangle.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  AppendedData appended;
  out << "<?xml version=\"1.0\"?>\n"
      << "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"" << vtk_byte_order()
      << "\" header_type=\"UInt64\">\n"
      << "  <PolyData>\n";
  write_texts(out, surface.texts);
  out << "    <Piece NumberOfPoints=\"" << surface.points.n_tuples
      << "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" << offsets.size() << "\">\n"
      << "      <PointData" << active("Scalars", surface.active_scalars) << active("Normals", surface.active_normals)
      << ">\n";
  write_arrays(out, surface.point_arrays, appended);
  out << "      </PointData>\n      <CellData>\n";
  write_arrays(out, surface.cell_arrays, appended);
  out << "      </CellData>\n      <Points>\n";
  write_arrays(out, {surface.points}, appended);
  out << "      </Points>\n      <Polys>\n";
  write_array(out, "connectivity", "Int64", 1,
              appended.add(connectivity.data(), connectivity.size() * sizeof(std::int64_t)));
  write_array(out, "offsets", "Int64", 1, appended.add(offsets.data(), offsets.size() * sizeof(std::int64_t)));
  out << "      </Polys>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _";
  appended.write(out);
  out << "\n  </AppendedData>\n</VTKFile>\n";
}

}  // namespace espdiff
