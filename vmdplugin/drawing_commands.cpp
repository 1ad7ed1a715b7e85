// drawing_commands.cpp: triangles, put_map, write_map: what came out, drawn and as maps.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "commands.h"
#include "graphics_draw.h"
#include "io/check_outputs.h"
#include "io/write_grid.h"
#include "report/difference_map.h"
#include "tcl_values.h"
#include "vertex_quantity.h"
#include "volume_store.h"

namespace espdiff::vmdplugin {
namespace {

/// VMD's colour scale: the first id and the last.
constexpr int kFirstScaleId = 33;

/// A surface as it is drawn: in the frame of the molecule that it belongs to.
struct DrawnSurface {
  std::vector<Vec3f> positions, normals;
  const std::vector<Triangle>* triangles = nullptr;
  std::vector<std::uint8_t> corrupt;                    ///< [triangle] empty where nothing was mapped
  const std::vector<std::uint8_t>* left_out = nullptr;  ///< [triangle] not part of the surface; null or empty for none
  const std::vector<float>* uncertainty = nullptr;  ///< [vertex] Angstrom: slip, or displacement
};

std::vector<Vec3f> single_precision(const std::vector<Vec3d>& positions) {
  std::vector<Vec3f> result;
  result.reserve(positions.size());
  for (const Vec3d& p : positions) result.push_back(static_cast<Vec3f>(p));
  return result;
}

DrawnSurface drawn_surface(const std::string& handle, const Object& object, const std::string& which,
                           const std::string& uncertainty) {
  require_done(handle, object);
  DrawnSurface drawn;
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(&object)) {
    drawn.positions = surface->result.mesh.positions;
    drawn.normals = surface->result.mesh.normals;
    drawn.triangles = &surface->result.mesh.triangles;
    return drawn;
  }
  const auto* comparison = dynamic_cast<const ComparisonObject*>(&object);
  if (comparison == nullptr) throw InputError(handle + " is a " + object.kind() + ", which has no surface");
  const MappedSurface& s = comparison->result.surface;
  if (which == "mapped") {
    drawn.positions = single_precision(s.positions);
    drawn.normals = s.normals;
    drawn.corrupt = s.corrupt;
    drawn.left_out = &s.unmatched;
  } else if (which == "source") {
    drawn.positions = single_precision(s.source_positions);
    drawn.normals = s.source_normals;
    drawn.corrupt = s.corrupt;
    for (std::size_t t = 0; t < s.unmatched.size(); ++t) drawn.corrupt[t] |= s.unmatched[t];
  } else {
    throw InputError("surface: '" + which + "' is not mapped or source");
  }
  drawn.triangles = &s.triangles;
  drawn.uncertainty = uncertainty == "slip" && !s.slip.empty() ? &s.slip : &s.displacement;
  return drawn;
}

std::vector<int> colours_of(const std::vector<float>& values, double low, double high, int plain) {
  std::vector<int> ids;
  ids.reserve(values.size());
  const double ids_per_unit = (kMostColourId - kFirstScaleId) / (high - low);
  for (const float value : values) {
    if (!std::isfinite(value)) {
      ids.push_back(plain);
      continue;
    }
    const double id = kFirstScaleId + (static_cast<double>(value) - low) * ids_per_unit;
    ids.push_back(std::clamp(static_cast<int>(std::lround(std::clamp(id, 0.0, 1e6))), kFirstScaleId, kMostColourId));
  }
  return ids;
}

/// Which triangles are drawn in one go: those of one level of uncertainty, so that each level can have an opacity.
struct OpacityBin {
  int bin, n_bins;
  double limit_A;  ///< uncertainty at which the last bin begins, times n / (n - 1)
};

int bin_of(const DrawnSurface& surface, std::size_t t, const OpacityBin& opacity) {
  if (surface.uncertainty == nullptr) return 0;
  double mean = 0;
  for (const std::uint32_t v : (*surface.triangles)[t]) mean += static_cast<double>((*surface.uncertainty)[v]) / 3;
  const double share = mean / opacity.limit_A;
  return std::isfinite(share) ? static_cast<int>(std::min(share, 1.0) * opacity.n_bins) : opacity.n_bins;
}

std::vector<std::uint8_t> select_triangles(const DrawnSurface& surface, const OpacityBin& opacity,
                                           const std::string& corrupt) {
  std::vector<std::uint8_t> drawn(surface.triangles->size(), 1);
  for (std::size_t t = 0; t < drawn.size(); ++t) {
    const bool is_corrupt = !surface.corrupt.empty() && surface.corrupt[t] != 0;
    const bool left_out = surface.left_out != nullptr && !surface.left_out->empty() && (*surface.left_out)[t] != 0;
    // What is corrupt is the least certain.
    const int bin =
        is_corrupt && corrupt == "bin" ? opacity.n_bins - 1 : std::min(bin_of(surface, t, opacity), opacity.n_bins - 1);
    const bool hidden = left_out || (is_corrupt && corrupt == "skip");
    drawn[t] = !hidden && bin == opacity.bin ? 1 : 0;
  }
  return drawn;
}

/// Vertices of corrupt triangles in the plain colour.
void mark_corrupt(const DrawnSurface& surface, int plain, std::vector<int>& colours) {
  for (std::size_t t = 0; t < surface.corrupt.size(); ++t) {
    if (surface.corrupt[t] == 0) continue;
    for (const std::uint32_t v : (*surface.triangles)[t]) colours[v] = plain;
  }
}

Tcl_Obj* triangles(const Call& call) {
  const std::string handle = call.text(0);
  const auto object = call.handles.find(handle);
  const int mol = to_int(call.arguments[1], "graphics molecule");
  DictReader reader(call.arguments[2], "options");
  const std::string color = reader.text("color", "none"), corrupt = reader.text("corrupt", "normal");
  if (corrupt != "normal" && corrupt != "plain" && corrupt != "bin" && corrupt != "skip")
    throw InputError("corrupt: '" + corrupt + "' is not normal, plain, bin or skip");
  const DrawnSurface surface = drawn_surface(handle, *object, reader.text("surface", "mapped"), reader.text("uncertainty", "slip"));
  const double low = reader.number("low", -1), high = reader.number("high", 1);
  if (!(high > low))
    throw InputError("range: " + std::to_string(low) + " to " + std::to_string(high) +
                     " is not from a lower to a higher value");
  const int plain = reader.integer("plain", 8);
  const OpacityBin opacity{reader.integer("opacity_bin", 0), reader.integer("n_bins", 1),
                           reader.number("uncertainty_limit", 1)};
  if (opacity.n_bins < 1 || opacity.bin < 0 || opacity.bin >= opacity.n_bins || !(opacity.limit_A > 0))
    throw InputError("opacity_bin " + std::to_string(opacity.bin) + " of n_bins " + std::to_string(opacity.n_bins) +
                     " with an uncertainty_limit of " + std::to_string(opacity.limit_A) + " A makes no sense");
  reader.finish();

  TriangleSoup soup;
  soup.positions = &surface.positions;
  soup.normals = &surface.normals;
  soup.triangles = surface.triangles;
  soup.colour = color == "none" ? std::vector<int>(surface.positions.size(), plain)
                                : colours_of(vertex_quantity(handle, *object, color).values, low, high, plain);
  if (corrupt == "plain") mark_corrupt(surface, plain, soup.colour);
  soup.drawn = select_triangles(surface, opacity, corrupt);
  return to_obj(draw_triangles(call.interp, mol, soup));
}

/// The quantity carried onto a lattice around the mapped surface.
Grid quantity_map(const Call& call) {
  const std::string handle = call.text(0), name = call.text(1);
  const auto comparison = call.handles.finished_comparison(handle);
  const VertexQuantity quantity = vertex_quantity(handle, *comparison, name);
  Grid map = surface_quantity_map(comparison->result.surface, quantity.values, to_double(call.arguments[2], "spacing"));
  map.unit = name == "displacement" || name == "slip" || name == "path_length" || name == "sign" ? PotentialUnit::kUnknown
                                                                               : comparison->result.unit;
  map.name = "espdiff " + name + (quantity.unit.empty() ? "" : " (" + quantity.unit + ")");
  return map;
}

Tcl_Obj* write_map(const Call& call) {
  const std::string path = call.text(3);
  std::vector<std::string> inputs;
  for (const InputFile& input : call.handles.finished_comparison(call.text(0))->provenance.inputs)
    inputs.push_back(input.path);
  check_outputs(inputs, {path});
  write_dx(path, quantity_map(call));
  return to_obj(path);
}

Tcl_Obj* put_map(const Call& call) {
  Grid map = quantity_map(call);
  const std::string dataname = map.name, name = "espdiff-" + call.text(0) + "-" + call.text(1);
  put_volume(name, std::move(map), dataname);
  return to_obj(name);
}

}  // namespace

std::vector<Command> drawing_commands() {
  return {{"triangles", 3, 3, "handle molecule options", triangles},
          {"put_map", 3, 3, "handle quantity spacing", put_map},
          {"write_map", 4, 4, "handle quantity spacing file", write_map}};
}

}  // namespace espdiff::vmdplugin
