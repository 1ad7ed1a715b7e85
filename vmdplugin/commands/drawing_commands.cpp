// drawing_commands.cpp: triangles, put_map, write_map: results drawn in VMD, and as maps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "commands.h"
#include "io/files/check_outputs.h"
#include "io/grids/write_grid.h"
#include "report/difference_map.h"
#include "scene/reasons.h"
#include "vmdplugin/bridge/graphics_draw.h"
#include "vmdplugin/bridge/volume_store.h"
#include "vmdplugin/objects/drawn_part.h"
#include "vmdplugin/objects/ensemble_views.h"
#include "vmdplugin/objects/vertex_quantity.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

/// The first id of VMD's colour scale; the last one is kMostColourId.
constexpr int kFirstScaleId = 33;

std::vector<Vec3f> single_precision(const std::vector<Vec3d>& positions) {
  std::vector<Vec3f> result;
  result.reserve(positions.size());
  for (const Vec3d& p : positions) result.push_back(static_cast<Vec3f>(p));
  return result;
}

/// The target's surface that nothing was mapped to, a little below itself: where the mapped surface reaches over its
/// border, the mapped surface is seen.
DrawnSurface drawn_uncovered(const UncoveredSurface& surface) {
  constexpr float kBelow_A = 0.1F;
  DrawnSurface drawn;
  drawn.positions = single_precision(surface.positions);
  for (std::size_t v = 0; v < drawn.positions.size(); ++v)
    drawn.positions[v] = drawn.positions[v] - kBelow_A * surface.normals[v];
  drawn.normals = surface.normals;
  drawn.triangles = &surface.triangles;
  drawn.unmatched = &surface.uncovered;
  drawn.has_unmatched_positions = true;
  drawn.border = 0.01F;  // beyond the border of the mapped surface
  return drawn;
}

DrawnSurface drawn_surface(const std::string& handle, const Object& object, const std::string& which) {
  require_done(handle, object);
  DrawnSurface drawn;
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(&object)) {
    drawn.positions = surface->result.mesh.positions;
    drawn.normals = surface->result.mesh.normals;
    drawn.triangles = &surface->result.mesh.triangles;
    return drawn;
  }
  const auto* comparison = dynamic_cast<const ComparisonObject*>(&object);
  if (comparison == nullptr) throw InputError(handle + " is " + kind_in_words(object) + ", which has no surface");
  const MappedSurface& s = comparison->result.surface;
  if (which == "mapped") {
    drawn.positions = single_precision(s.positions);
    drawn.normals = s.normals;
  } else if (which == "source") {
    drawn.positions = single_precision(s.source_positions);
    drawn.normals = s.source_normals;
    drawn.has_unmatched_positions = true;
  } else if (which != "uncovered") {
    throw InputError("surface: '" + which + "' is not mapped, source or uncovered");
  }
  if (which == "uncovered") return drawn_uncovered(comparison->result.uncovered);
  drawn.triangles = &s.triangles;
  for (const std::uint8_t why : s.why)
    drawn.untrusted.push_back(why != static_cast<std::uint8_t>(Why::kTrusted) &&
                              why != static_cast<std::uint8_t>(Why::kUnmatched));
  drawn.unmatched = &s.unmatched;
  drawn.uncertainty = &vertex_uncertainty(s);
  drawn.why = &s.why;
  drawn.turned = &s.turned;
  return drawn;
}

/// Colour ids of values; those that are NaN get the colour `plain`.
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

DrawnPart parse_part(DictReader& reader) {
  DrawnPart part;
  part.limit_A = reader.number("limit", 0);
  part.from = static_cast<float>(reader.number("from", 0));
  part.to = static_cast<float>(reader.number("to", 1e9));
  part.corrupt = reader.text("corrupt", "normal");
  part.hatches = reader.boolean("hatches", false);
  part.plain = reader.integer("plain", 8);
  part.marked = reader.integer("marked", 4);
  part.light = reader.integer("light", kMostColourId);
  part.reason = reader.integer("reason", -1);
  if (part.corrupt != "normal" && part.corrupt != "uncertain" && part.corrupt != "mark" && part.corrupt != "hide")
    throw InputError("corrupt: '" + part.corrupt + "' is not normal, uncertain, mark or hide");
  if (!(part.limit_A >= 0) || !(part.to > part.from))
    throw InputError("a band of uncertainty from " + formatted(part.from) + " to " + formatted(part.to) +
                     " of a limit of " + formatted(part.limit_A) + " A is empty");
  return part;
}

Tcl_Obj* triangles(const Call& call) {
  const std::string handle = call.text(0);
  const auto object = call.handles.find(handle);
  const int mol = to_int(call.arguments[1], "graphics molecule");
  DictReader reader(call.arguments[2], "options");
  const std::string color = reader.text("color", "none");
  const std::string which = reader.text("surface", "mapped");
  const auto of_ensemble = ensemble_surface(handle, *object, DrawnName(color).field, reader.integer("patch", 0));
  const DrawnSurface surface = of_ensemble ? *of_ensemble : drawn_surface(handle, *object, which);
  const double low = reader.number("low", -1), high = reader.number("high", 1);
  if (!(high > low))
    throw InputError("range: " + formatted(low) + " to " + formatted(high) + " is not from a lower to a higher value");
  const DrawnPart part = parse_part(reader);
  reader.finish();
  if (part.reason >= static_cast<int>(kNumberOfDrawnReasons) || (part.reason >= 0 && surface.why == nullptr))
    throw InputError("reason: " + formatted(part.reason) + " is none of this surface");

  std::vector<float> values(surface.positions.size(), std::numeric_limits<float>::quiet_NaN());
  if (color != "none") values = vertex_quantity(handle, *object, color).values;
  const CutPart cut = cut_part(surface, part, std::move(values));
  const std::size_t n_vertices = cut.surface.positions().size();
  std::size_t n_drawn = 0;
  const auto draw = [&](const std::vector<Triangle>& some, std::vector<int> colours) {
    if (some.empty()) return;
    TriangleSoup soup;
    soup.positions = &cut.surface.positions();
    soup.normals = &cut.surface.normals();
    soup.triangles = &some;
    soup.colour = std::move(colours);
    n_drawn += draw_triangles(call.interp, mol, soup);
  };
  draw(cut.coloured, colours_of(cut.surface.field(cut.value), low, high, part.plain));
  draw(cut.marked, std::vector<int>(n_vertices, part.marked));
  draw(cut.dark, std::vector<int>(n_vertices, part.plain));
  draw(cut.light, std::vector<int>(n_vertices, part.light));
  return to_obj(n_drawn);
}

/// What a comparison's surface is drawn as by reason: number, words and share of the source's surface, of each that
/// occurs.
Tcl_Obj* reasons(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  const MappedSurface& s = comparison->result.surface;
  const auto areas = areas_of_reasons({s.triangles, s.why, s.turned}, s.source_positions);
  Tcl_Obj* const list = Tcl_NewListObj(0, nullptr);
  for (std::size_t r = 0; r < areas.size(); ++r) {
    if (!(areas[r] > 0)) continue;
    for (Tcl_Obj* entry : {to_obj(r), to_obj(std::string(kDrawnReasons[r].words)), to_obj(areas[r])})
      Tcl_ListObjAppendElement(nullptr, list, entry);
  }
  return list;
}

/// The quantity carried onto a lattice around the mapped surface.
Grid quantity_map(const Call& call) {
  const std::string handle = call.text(0), name = call.text(1);
  const auto comparison = call.handles.finished_comparison(handle);
  const VertexQuantity quantity = vertex_quantity(handle, *comparison, name);
  Grid map = surface_quantity_map(comparison->result.surface, quantity.values, to_double(call.arguments[2], "spacing"));
  map.unit = name == "displacement" || name == "slip" || name == "path_length" || name == "sign" ||
                     !DrawnName(name).field.empty()
                 ? PotentialUnit::kUnknown
                 : comparison->result.potential.unit;
  map.name = "espdiff " + name + (quantity.unit.empty() ? "" : " (" + quantity.unit + ")");
  return map;
}

Tcl_Obj* write_map(const Call& call) {
  const std::string path = call.text(3);
  std::vector<std::string> inputs;
  for (const InputFile& input : call.handles.finished_comparison(call.text(0))->provenance.inputs)
    inputs.push_back(input.path);
  check_outputs(inputs, {path}, to_bool(call.arguments[4], "overwrite"));
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
  return {{"reasons", 1, 1, "handle", reasons},
          {"triangles", 3, 3, "handle molecule options", triangles},
          {"put_map", 3, 3, "handle quantity spacing", put_map},
          {"write_map", 5, 5, "handle quantity spacing file overwrite", write_map}};
}

}  // namespace espdiff::vmdplugin
