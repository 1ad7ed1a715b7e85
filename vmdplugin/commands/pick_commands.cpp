// pick_commands.cpp: pick_points, seen_point: what a click on a drawn surface hits, and what the surface has there.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "commands.h"
#include "vmdplugin/bridge/graphics_draw.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

/// The comparison's surface on one side, in that side's frame.
struct PickedSurface {
  std::shared_ptr<ComparisonObject> comparison;
  const std::vector<Vec3d>* positions = nullptr;
  bool has_unmatched = false;  ///< whether unmatched triangles have positions

  const MappedSurface& mapped() const { return comparison->result.surface; }
  bool is_there(std::size_t triangle) const {
    return has_unmatched || mapped().unmatched.empty() || mapped().unmatched[triangle] == 0;
  }
};

PickedSurface picked_surface(const Call& call, const std::string& which) {
  PickedSurface surface;
  surface.comparison = call.handles.finished_comparison(call.text(0));
  if (which != "mapped" && which != "source") throw InputError("surface: '" + which + "' is not mapped or source");
  surface.has_unmatched = which == "source";
  surface.positions = surface.has_unmatched ? &surface.mapped().source_positions : &surface.mapped().positions;
  return surface;
}

/// Points that VMD can pick, at all vertices that are drawn. Returns how many.
Tcl_Obj* pick_points(const Call& call) {
  const PickedSurface surface = picked_surface(call, call.text(2));
  std::vector<std::uint8_t> is_drawn(surface.positions->size(), 0);
  for (std::size_t t = 0; t < surface.mapped().triangles.size(); ++t) {
    if (!surface.is_there(t)) continue;
    for (const std::uint32_t vertex : surface.mapped().triangles[t]) is_drawn[vertex] = 1;
  }
  std::vector<Vec3f> points;
  for (std::size_t v = 0; v < is_drawn.size(); ++v) {
    if (is_drawn[v] != 0) points.push_back(static_cast<Vec3f>((*surface.positions)[v]));
  }
  add_pick_points(call.interp, to_int(call.arguments[1], "graphics molecule"), points);
  return to_obj(points.size());
}

Vec3d to_vec(Tcl_Obj* value, const std::string& what) {
  const std::vector<Tcl_Obj*> numbers = to_vector(value, what);
  if (numbers.size() != 3) throw InputError(what + ": '" + to_string(value) + "' are not three numbers");
  return {to_double(numbers[0], what), to_double(numbers[1], what), to_double(numbers[2], what)};
}

/// Where a ray meets a triangle.
struct Hit {
  std::size_t triangle = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< in lengths of the direction
  std::array<double, 3> weights{};                            ///< of the triangle's corners
};

/// The first triangle on a ray, by the equations of T. Moeller and B. Trumbore, "Fast, minimum storage ray-triangle
/// intersection" (1997), doi:10.1080/10867651.1997.10487468.
std::optional<Hit> first_hit(const PickedSurface& surface, Vec3d from, Vec3d direction) {
  Hit best;
  for (std::size_t t = 0; t < surface.mapped().triangles.size(); ++t) {
    if (!surface.is_there(t)) continue;
    const Triangle& corners = surface.mapped().triangles[t];
    const Vec3d a = (*surface.positions)[corners[0]];
    const Vec3d ab = (*surface.positions)[corners[1]] - a, ac = (*surface.positions)[corners[2]] - a;
    const Vec3d p = cross(direction, ac);
    const double volume = dot(ab, p);
    if (std::fabs(volume) < 1e-12) continue;
    const Vec3d away = from - a, q = cross(away, ab);
    const double u = dot(away, p) / volume, v = dot(direction, q) / volume, distance = dot(ac, q) / volume;
    if (u < 0 || v < 0 || u + v > 1 || distance < 0 || distance >= best.distance) continue;
    best = {t, distance, {1 - u - v, u, v}};
  }
  if (std::isinf(best.distance)) return std::nullopt;
  return best;
}

/// A value between the corners; empty without values.
Tcl_Obj* at_hit(const std::vector<float>& values, const Triangle& corners, const Hit& hit) {
  if (values.empty()) return to_obj("");
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += hit.weights[k] * static_cast<double>(values[corners[k]]);
  return to_obj(sum);
}

/// What is seen along the line from the eye through a point: the first triangle's values there.
Tcl_Obj* seen_point(const Call& call) {
  const PickedSurface surface = picked_surface(call, call.text(1));
  const Vec3d eye = to_vec(call.arguments[2], "eye"), point = to_vec(call.arguments[3], "point");
  const std::optional<Hit> hit = first_hit(surface, eye, point - eye);
  if (!hit) return nullptr;
  const MappedSurface& s = surface.mapped();
  const Triangle& corners = s.triangles[hit->triangle];
  const auto nearest = static_cast<std::size_t>(
      std::distance(hit->weights.begin(), std::max_element(hit->weights.begin(), hit->weights.end())));
  const Vec3d place = eye + hit->distance * (point - eye);
  const bool is_matched = s.unmatched.empty() || s.unmatched[hit->triangle] == 0;
  const std::vector<float> none;
  return to_dict({{"position", to_list({to_obj(place.x), to_obj(place.y), to_obj(place.z)})},
                  {"residue", to_obj(static_cast<int>(s.residue[corners[nearest]]))},
                  {"matched", to_obj(is_matched)},
                  {"source", at_hit(s.potential_source, corners, *hit)},
                  {"target", at_hit(is_matched ? s.potential_target : none, corners, *hit)},
                  {"displacement", at_hit(is_matched ? s.displacement : none, corners, *hit)},
                  {"slip", at_hit(is_matched ? s.slip : none, corners, *hit)}});
}

}  // namespace

std::vector<Command> pick_commands() {
  return {{"pick_points", 3, 3, "handle molecule surface", pick_points},
          {"seen_point", 4, 4, "handle surface eye point", seen_point}};
}

}  // namespace espdiff::vmdplugin
