// surface_file.cpp: takes what drawing needs from a .vtp and checks it.
#include "scene/surface_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/error.h"
#include "io/files/file_kind.h"
#include "io/files/read_input.h"
#include "io/text/text_cursor.h"
#include "io/vtk/read_vtp.h"
#include "scene/reasons.h"

namespace espdiff {
namespace {

std::string names_of(const VtpContent& surface) {
  std::string names;
  for (const VtpNumbers& array : surface.point_arrays) names += (names.empty() ? "" : ", ") + array.name;
  return names.empty() ? "none" : names;
}

/// Unit normals at the vertices: the mean of those of the triangles around, each of equal weight.
std::vector<Vec3f> mean_normals(const VtpContent& surface) {
  std::vector<Vec3d> sums(surface.positions.size());
  for (const Triangle& t : surface.triangles) {
    const Vec3d& a = surface.positions[t[0]];
    const Vec3d normal = cross(surface.positions[t[1]] - a, surface.positions[t[2]] - a);
    const double length = norm(normal);
    for (const std::uint32_t vertex : t) {
      if (length > 0) sums[vertex] += 1 / length * normal;
    }
  }
  std::vector<Vec3f> normals(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const double length = norm(sums[v]);
    if (length > 0) normals[v] = static_cast<Vec3f>(1 / length * sums[v]);
  }
  return normals;
}

void check_exists(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status))
    throw IoError(path, "no such file; `espdiff compare SOURCE TARGET -o OUT` writes OUT.vtp");
  if (std::filesystem::is_directory(status)) throw IoError(path, "is a directory; name the .vtp file in it");
}

/// [triangle] nonzero entries of a cell array; empty when the file has none of that name.
std::vector<std::uint8_t> flags_of(const VtpContent& surface, const char* name) {
  std::vector<std::uint8_t> flags;
  const VtpNumbers* const array = find_array(surface.cell_arrays, name);
  if (array == nullptr || array->n_components != 1) return flags;
  for (const double value : array->values) flags.push_back(value != 0 ? 1 : 0);
  return flags;
}

/// [vertex] numbers of a point array; empty when the file has none of that name.
std::vector<float> numbers_of(const VtpContent& surface, const char* name) {
  const VtpNumbers* const array = find_array(surface.point_arrays, name);
  if (array == nullptr || array->n_components != 1) return {};
  std::vector<float> numbers;
  for (const double value : array->values) numbers.push_back(static_cast<float>(value));
  return numbers;
}

std::string text_of(const VtpContent& surface, const char* name) {
  for (const auto& [key, text] : surface.texts) {
    if (key == name) return text;
  }
  return {};
}

/// Empty if there is none with three components.
template <typename Vector>
std::vector<Vector> vectors_of(const VtpContent& surface, const char* name) {
  const VtpNumbers* const array = find_array(surface.point_arrays, name);
  std::vector<Vector> vectors;
  if (array == nullptr || array->n_components != 3) return vectors;
  const std::vector<double>& values = array->values;
  for (std::size_t i = 0; i < values.size(); i += 3) {
    vectors.push_back(static_cast<Vector>(Vec3d{values[i], values[i + 1], values[i + 2]}));
  }
  return vectors;
}

void read_arrays(SurfaceFile& file, const VtpContent& surface) {
  file.normals = vectors_of<Vec3f>(surface, "normal");
  if (file.normals.empty()) file.normals = mean_normals(surface);
  file.source_positions = vectors_of<Vec3d>(surface, "source_position");
  file.source_normals = vectors_of<Vec3f>(surface, "source_normal");
  file.displacement = numbers_of(surface, "displacement");
  file.slip = numbers_of(surface, "slip");
  file.potential_source = numbers_of(surface, "potential_source");
  file.potential_target = numbers_of(surface, "potential_target");
  file.potential_difference = numbers_of(surface, "potential_difference");
  file.sign_change = numbers_of(surface, "sign_change");
  if (file.potential_difference.size() == file.sign_change.size()) {
    for (std::size_t i = 0; i < file.sign_change.size(); ++i) {
      if (std::isnan(file.potential_difference[i])) file.sign_change[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  file.p_family_wise = numbers_of(surface, "p_family_wise");
  for (float& p : file.p_family_wise) p = std::isnan(p) ? 0 : p;
  if (const std::string alpha = text_of(surface, "alpha"); !alpha.empty()) parse_number(alpha, file.alpha);
  file.residue_index = numbers_of(surface, "residue_index");
  for (float& index : file.residue_index) {
    if (!(index >= 0 && index < 2e9F)) index = -1;  // becomes an integer later
  }
  file.residue_number = numbers_of(surface, "residue_number");
  file.untrusted = flags_of(surface, "corrupt");
  file.unmatched = flags_of(surface, "no_counterpart");
  if (file.unmatched.empty()) file.unmatched = flags_of(surface, "untested");  // of an ensemble
  if (const VtpNumbers* const why = find_array(surface.cell_arrays, "why"); why != nullptr && why->n_components == 1) {
    for (const double code : why->values)
      file.why.push_back(static_cast<std::uint8_t>(code >= 0 && code < kNumberOfReasonCodes ? code : 0));
  }  // files of older versions lack it
  for (const float turn : numbers_of(surface, "turned")) file.turned.push_back(turn > 0 ? 1 : 0);
  for (std::size_t t = 0; t < file.why.size(); ++t) file.untrusted[t] = file.why[t] != 0 && file.is_matched(t) ? 1 : 0;
  file.potential_unit = text_of(surface, "potential_unit");
  file.source_group = text_of(surface, "source_group");
  file.target_group = text_of(surface, "target_group");
  file.written_by = text_of(surface, "written_by");
  file.array_names = names_of(surface);
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Names of the fields that the file has values of.
std::vector<std::string> fields_of(const VtpContent& surface) {
  const std::string ending = "_label";
  std::vector<std::string> names;
  for (const auto& [key, text] : surface.texts) {
    if (key.size() > ending.size() && key.compare(key.size() - ending.size(), ending.size(), ending) == 0)
      names.push_back(key.substr(0, key.size() - ending.size()));
  }
  return names;
}

/// Puts a field in the place of the potential.
void take_field(SurfaceFile& file, const VtpContent& surface, const std::string& field) {
  const std::string label = text_of(surface, (field + "_label").c_str());
  file.potential_source = numbers_of(surface, (field + "_source").c_str());
  file.potential_target = numbers_of(surface, (field + "_target").c_str());
  file.potential_difference = numbers_of(surface, (field + "_difference").c_str());
  if (label.empty() || file.potential_difference.empty()) {
    throw InputError(
        file.path + ": has no field '" + field + "'; it has " +
        (file.fields.empty() ? "none: compare with " + option("field", "NAME") : Message(joined_names(file.fields))));
  }
  file.field = field;
  file.quantity = label;
  file.potential_unit = text_of(surface, (field + "_unit").c_str());
  file.is_signed = text_of(surface, (field + "_signed").c_str()) != "0";
  file.sign_change.clear();
  if (!file.is_signed) return;
  for (std::size_t v = 0; v < file.potential_source.size(); ++v) {
    const float a = file.potential_source[v], b = file.potential_target[v];
    file.sign_change.push_back(std::isnan(a + b) ? a + b : (a < 0 && b > 0) || (a > 0 && b < 0) ? 1.0F : 0.0F);
  }
}

}  // namespace

const std::vector<float>& SurfaceFile::uncertainty() const {
  if (!p_family_wise.empty()) return p_family_wise;
  const bool knows_slip = std::any_of(slip.begin(), slip.end(), [](float value) { return std::isfinite(value); });
  return knows_slip ? slip : displacement;
}

const std::vector<float>& SurfaceFile::values(RenderArray array) const {
  static const std::vector<float> nothing;
  const auto pick = [&]() -> const std::vector<float>& {
    switch (array) {
      case RenderArray::kDifference:
      case RenderArray::kMagnitude: return potential_difference;
      case RenderArray::kSource: return potential_source;
      case RenderArray::kTarget: return potential_target;
      case RenderArray::kSign: return sign_change;
      case RenderArray::kDisplacement: return displacement;
      case RenderArray::kSlip: return slip;
      case RenderArray::kResidue: return residue_index;
      case RenderArray::kPlain:
      case RenderArray::kWhy: break;
    }
    return nothing;
  };
  if (array == RenderArray::kWhy && why.empty()) {
    throw InputError(path + ": has no cell array 'why', so that it cannot be drawn by reason; compare the pair again");
  }
  if (pick().empty() && array != RenderArray::kPlain && array != RenderArray::kWhy) {
    const std::string lacks = path + ": no point array '" + array_name(array) + "' (there are: " + array_names + "); ";
    if (potential_difference.empty() && !fields.empty())
      throw InputError(lacks + "draw one of its fields, " + option("field", fields.front()) +
                       (fields.size() > 1 ? " of " + joined_names(fields) : "") + ", or colour by another array");
    throw InputError(lacks + "colour by another, or compare with " + option("source-map") + " and " +
                     option("target-map"));
  }
  return pick();
}

SurfaceFile read_surface_file(const std::string& path, const std::string& field) {
  check_exists(path);
  VtpContent surface = read_vtp(read_input(path, [&](std::string_view head) {
    if (head.find("<VTKFile") == std::string::npos || head.find("PolyData") == std::string::npos)
      throw FormatError(path, 0,
                        "not a VTK PolyData file (.vtp); `espdiff compare SOURCE TARGET -o OUT` writes OUT.vtp");
  }));
  if (surface.triangles.empty()) throw FormatError(path, 0, "the surface has no triangles; nothing to draw");
  SurfaceFile file;
  file.path = path;
  read_arrays(file, surface);
  file.fields = fields_of(surface);
  const bool is_field_of_ensemble = !file.p_family_wise.empty() && file.potential_difference.empty();
  if (!field.empty()) {
    take_field(file, surface, field);
  } else if (is_field_of_ensemble && file.fields.size() == 1) {
    take_field(file, surface, file.fields.front());
  }
  file.triangles = std::move(surface.triangles);
  file.positions = std::move(surface.positions);
  const auto& lost = file.unmatched;
  if (!lost.empty() && std::find(lost.begin(), lost.end(), 0) == lost.end()) {
    throw FormatError(path, 0, "no triangle has a counterpart; nothing to draw");
  }
  return file;
}

}  // namespace espdiff
