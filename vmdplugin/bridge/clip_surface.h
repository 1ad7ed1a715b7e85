// clip_surface.h: cuts a surface along isolines of fields at its vertices, so that parts of a drawing meet in smooth
// lines.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A convex polygon of vertices in order: a triangle that was cut.
using Polygon = std::vector<std::uint32_t>;

/// A mesh whose triangles can be cut. Cuts append vertices; all of a vertex is interpolated linearly.
class ClippedSurface {
 public:
  using FieldId = std::size_t;

  /// @param positions [vertex] Angstrom  @param normals [vertex] unit
  ClippedSurface(std::vector<Vec3f> positions, std::vector<Vec3f> normals);

  /// @param values [vertex]
  FieldId add_field(std::vector<float> values);

  /// The part of a polygon where the field is below the level, or at least the level. Empty if there is none. Polygons
  /// that share an edge get the same vertex on it.
  Polygon keep_below(const Polygon& polygon, FieldId field, float level);
  Polygon keep_above(const Polygon& polygon, FieldId field, float level);

  /// Appends a polygon as triangles.
  static void append_fan(const Polygon& polygon, std::vector<Triangle>& triangles);

  const std::vector<Vec3f>& positions() const { return positions_; }
  const std::vector<Vec3f>& normals() const { return normals_; }
  const std::vector<float>& field(FieldId id) const { return fields_[id]; }

 private:
  Polygon keep(const Polygon& polygon, FieldId field, float level, bool below);
  std::uint32_t cut_edge(std::uint32_t a, std::uint32_t b, FieldId field, float level);

  std::vector<Vec3f> positions_, normals_;
  std::vector<std::vector<float>> fields_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, FieldId, float>, std::uint32_t> cuts_;  ///< by edge
};

/// Smooth share of flagged triangles around each vertex, 0 to 1: the fraction of its triangles that are flagged, three
/// times averaged with its neighbours. Its isoline at 0.5 follows the border of the flagged region without its teeth.
/// @param flags [triangle]; empty for none
/// @returns [vertex]
std::vector<float> flagged_share(const std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& flags,
                                 std::size_t n_vertices);

}  // namespace espdiff
