// drawn_part.h: one part of a drawn surface: a band of uncertainty, cut out of the surface along smooth lines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
#include "vmdplugin/bridge/clip_surface.h"

namespace espdiff::vmdplugin {

/// A surface as it is drawn: in the frame of the molecule that it belongs to.
struct DrawnSurface {
  std::vector<Vec3f> positions, normals;
  const std::vector<Triangle>* triangles = nullptr;
  std::vector<std::uint8_t> untrusted;  ///< [triangle] matched and not trusted; empty where nothing was mapped
  const std::vector<std::uint8_t>* unmatched = nullptr;  ///< [triangle] null or empty for none
  bool has_unmatched_positions = false;                  ///< whether unmatched triangles can be drawn
  float border = 0.5F;  ///< share of unmatched triangles around the line at which the unmatched part begins
  const std::vector<float>* uncertainty = nullptr;    ///< [vertex] null where nothing was mapped
  const std::vector<std::uint8_t>* why = nullptr;     ///< [triangle] and
  const std::vector<std::uint8_t>* turned = nullptr;  ///< [vertex] of a comparison; null of other surfaces
};

/// What one call of `triangles` draws.
struct DrawnPart {
  double limit_A = 0;        ///< uncertainty at which colours have faded; 0 for no fading
  float from = 0, to = 1e9;  ///< the band of uncertainty, in units of the limit
  std::string corrupt;   ///< uncertain: parts that are not trusted have the greatest uncertainty; mark, hide, normal
  bool hatches = false;  ///< draws unmatched parts, hatched
  int reason = -1;       ///< draws only what has this reason (kDrawnReasons); -1 for all
  int plain = 0, marked = 0, light = 0;  ///< colour ids: no value, parts that are not trusted, light stripes
};

/// The triangles of a part, by how they are coloured.
struct CutPart {
  ClippedSurface surface;
  ClippedSurface::FieldId value = 0;  ///< of the surface: the drawn quantity
  std::vector<Triangle> coloured;     ///< by the quantity
  std::vector<Triangle> marked;       ///< not trusted
  std::vector<Triangle> dark, light;  ///< stripes of unmatched parts
};

/// @param values [vertex] of the drawn quantity; NaN where there is none
CutPart cut_part(const DrawnSurface& surface, const DrawnPart& part, std::vector<float> values);

}  // namespace espdiff::vmdplugin
