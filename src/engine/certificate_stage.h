// certificate_stage.h: metrics of a comparison, and how well a mapped surface fits its target.
#pragma once

#include <cstddef>

#include "engine/handles.h"

namespace espdiff {

/// Area-weighted comparison of two potentials on the mapped mesh. Weights are a third of the area of each counted
/// triangle at each of its vertices. Potentials in the unit of the samples.
struct Metrics {
  double area_A2 = 0;  ///< of the counted triangles of the mapped mesh; all else is NaN when it is 0
  double mean_abs_difference = 0;
  double rms_difference = 0;
  double mean_signed_difference = 0;     ///< target - source
  double sign_change_area_fraction = 0;  ///< a vertex with a potential of exactly 0 agrees with anything
  double hodgkin_index = 0;              ///< 2<ab> / (<aa> + <bb>)
  double carbo_index = 0;                ///< <ab> / sqrt(<aa><bb>)
  double mean_displacement_A = 0;        ///< |mapped - source| in the common frame
  double mean_path_length_A = 0;         ///< of the vertices' ways from the one to the other; NaN where not given
};

/// Distances of one surface's vertices to the other surface's triangles, area-weighted over its vertices. Angstrom.
struct DistanceSummary {
  double mean = 0;
  double p95 = 0;  ///< 95 % of the area lies nearer
  double max = 0;
  double area_fraction_beyond_limit = 0;
  double mean_within_limit = 0;  ///< of the area within the limit
  ScalarsPtr beyond;             ///< [triangle of the first surface] 1 where a corner lies beyond the limit, else 0
};

/// How well a mapped mesh fits its target.
struct FitReport {
  double corrupt_area_fraction =
      0;  ///< triangles whose analytic density at the centroid is off the isovalue by more than 0.1
  double flipped_area_fraction = 0;  ///< triangles whose normal opposes the density's outward normal at their centroid
  double irregularity_A = 0;         ///< mean length of the umbrella Laplacian
  double area_A2 = 0;
  ScalarsPtr corrupt;  ///< [triangle] 1 where corrupt, else 0
  ScalarsPtr flipped;  ///< [triangle] 1 where flipped, else 0
};

/// How a mapping changes areas and shapes; see Engine::distortion(). Quantiles by the source's area.
struct DistortionReport {
  double area_ratio_p05 = 1, area_ratio_median = 1, area_ratio_p95 = 1;  ///< mapped area / source area
  /// Symmetric Dirichlet energy (|J|^2 + |J^-1|^2) / 4, J the triangle's linear map: 1 where nothing is distorted,
  /// infinite for a triangle without area.
  double dirichlet_median = 1, dirichlet_p95 = 1;
  ScalarsPtr excessive;  ///< [triangle] 1 where the area around it has grown by more than the limit, else 0
};

/// The triangles of a closed mesh that intersect one another; see Engine::self_intersections().
struct IntersectionReport {
  std::size_t n_pairs = 0;       ///< of triangles that intersect, and each triangle without area as a pair with itself
  std::size_t n_degenerate = 0;  ///< the latter
  ScalarsPtr intersecting;       ///< [triangle] 1 where it takes part in a pair, else 0
};

}  // namespace espdiff
