// certificate_stage.h: metrics of a comparison, and measures of how well a mapped surface fits its target.
#pragma once

#include <cstddef>

#include "base/handles.h"

namespace espdiff {

/// Area-weighted comparison of two potentials on the mapped mesh. Weights are a third of the area of each valid
/// triangle at each of its vertices. Potentials have the unit of the samples.
struct Metrics {
  double area_A2 = 0;  ///< of the valid triangles of the mapped mesh; if it is 0, all other values are NaN
  double mean_abs_difference = 0;
  double rms_difference = 0;
  double mean_signed_difference = 0;     ///< target - source
  double sign_change_area_fraction = 0;  ///< a potential of exactly 0 agrees with either sign
  double hodgkin_index = 0;              ///< 2<ab> / (<aa> + <bb>)
  double carbo_index = 0;                ///< <ab> / sqrt(<aa><bb>)
  double mean_displacement_A = 0;        ///< |mapped - source| in the common frame
  double mean_path_length_A = 0;         ///< mean path length of the vertices from source to mapped; NaN if not given
  double correlation = 0;                ///< Pearson's; NaN where a side is constant
};

/// Distances of one surface to the other surface's triangles, area-weighted over the corners (a quarter) and centroids
/// (three quarters) of its triangles. Angstrom.
struct DistanceSummary {
  double mean = 0;
  double p95 = 0;  ///< 95 % of the area is closer
  double max = 0;
  double area_fraction_beyond_limit = 0;
  double mean_within_limit = 0;  ///< over the area within the limit
  ScalarsPtr beyond;             ///< [triangle of the first surface] 1 if a corner lies beyond the limit, otherwise 0
  ScalarsPtr distances{};        ///< [vertex of the first surface, then triangle] of the corners and centroids
};

/// How well a mapped mesh fits its target.
struct FitReport {
  double corrupt_area_fraction =
      0;  ///< triangles whose analytic density at the centroid is off the isovalue by more than 0.1
  double flipped_area_fraction = 0;  ///< triangles whose normal opposes the density's outward normal at their centroid
  double irregularity_A = 0;         ///< mean length of the umbrella Laplacian where triangles surround a vertex
  double area_A2 = 0;
  ScalarsPtr corrupt;  ///< [triangle] 1 if corrupt, otherwise 0
  ScalarsPtr flipped;  ///< [triangle] 1 if flipped, otherwise 0
};

/// How a mapping changes areas and shapes; see Engine::distortion(). Quantiles by the source's area.
struct DistortionReport {
  double area_ratio_p05 = 1, area_ratio_median = 1, area_ratio_p95 = 1;  ///< mapped area / source area
  /// Symmetric Dirichlet energy (|J|^2 + |J^-1|^2) / 4 with J the triangle's linear map: 1 without distortion, infinite
  /// for a triangle without area.
  double dirichlet_median = 1, dirichlet_p95 = 1;
  ScalarsPtr excessive;  ///< [triangle] 1 if the surrounding area has grown by more than the limit, otherwise 0
};

/// The triangles of a closed mesh that intersect one another; see Engine::self_intersections().
struct IntersectionReport {
  std::size_t n_pairs = 0;       ///< of intersecting triangles; a triangle without area is a pair with itself
  std::size_t n_degenerate = 0;  ///< number of triangles without area
  ScalarsPtr intersecting;       ///< [triangle] 1 if in any pair, otherwise 0
};

}  // namespace espdiff
