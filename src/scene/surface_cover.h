// surface_cover.h: where pictures draw what a mapping left unmatched, and which vertices belong to what is outlined.
#pragma once

#include <vector>

#include "base/types.h"
#include "scene/surface_file.h"

namespace espdiff {

/// A surface without holes, for drawing only: no number of a result comes from here.
struct SurfaceCover {
  std::vector<Vec3d> positions;  ///< [vertex] mapped; of vertices without a matched triangle, see cover_of()
  std::vector<Vec3f> normals;    ///< [vertex] unit, outward, at these positions
  /// [vertex] 1 in matched parts, 0 in unmatched ones, -1 inside tears (unmatched triangles that are drawn much larger
  /// than they are on the source: no surface is there), smooth between. The border at 0.5 lies in matched triangles,
  /// about half a triangle from the unmatched ones; surface.frag leaves tears open.
  std::vector<float> matched;
  std::vector<float> trusted;  ///< [vertex] 1 in parts that are not marked as not trusted, 0 in others, smooth between
};

/// Vertices that only unmatched triangles have get the place of the superposed source, displaced as their surroundings
/// are: the displacements of the border, spread harmonically over the unmatched part.
/// @param start [vertex] the superposed source
SurfaceCover cover_of(const SurfaceFile& surface, const std::vector<Vec3f>& start);

/// [vertex] whether only unmatched triangles have it.
std::vector<bool> unmatched_vertices(const SurfaceFile& surface);

/// Values of such vertices that have none become the means of their neighbours', so that colours reach the border.
std::vector<float> filled_at_border(const SurfaceFile& surface, std::vector<float> values);

/// [vertex] share of the residues in a list around it, smooth; the outline lies at 0.5. Empty without residues.
std::vector<float> share_of_residues(const SurfaceFile& surface, const std::vector<int>& residues);

}  // namespace espdiff
