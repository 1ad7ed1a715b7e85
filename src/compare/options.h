// options.h: all parameters of a comparison.
#pragma once

#include <string>

#include "align/pair_atoms.h"
#include "engine/deform_stage.h"
#include "engine/morph_stage.h"

namespace espdiff {

/// What draws the surface in `deform`: the target's density, the distance to it where that is far, or gradient vector
/// flow from the target, or from both surfaces.
enum class FieldKind { kDensity, kDistance, kGvf, kGvf2 };
FieldKind parse_field_kind(const std::string& text);
std::string to_string(FieldKind field);
Interpolation parse_interpolation(const std::string& text);

/// How the source's surface is brought onto the target's: by forces in a field of the target (the thesis), or carried
/// by the level sets of the density while the atoms move.
enum class Method { kDeform, kMorph };
Method parse_method(const std::string& text);
std::string to_string(Method method);

/// How a surface is made of a molecule.
struct SurfaceOptions {
  double grid_spacing_A = 1.0;
  double radius_scale = 1.0;
  double isovalue = 0.5;
  bool cavities = false;  ///< keep closed cavities; else they are counted and left out
  bool project = true;    ///< move vertices onto the analytic isosurface
};

/// All parameters of a comparison; defaults are the study's values of the thesis where it has them. Not in the thesis:
/// tangential gains other than 1, the rest shape, the projection onto the exact isosurface, and the mapping's smaller
/// min_displacement.
struct CompareOptions {
  SurfaceOptions surface;
  AlignAtoms align = AlignAtoms::kAll;
  std::string domains = "none";  ///< rigid domains that are aligned by themselves; see check_domains()
  Method method = Method::kMorph;
  MorphOptions morph;
  double morph_max_edge = 1.4;  ///< in grid spacings; sets MorphOptions::max_edge_A
  FieldKind field = FieldKind::kDistance;
  double distance_threshold_A = 0.75;
  VectorFlowOptions flow;
  bool subdivide = false;  ///< halve edges that deform has stretched, and go on; see map_by_deform.h
  DeformOptions regularize{0.1, 0.5, 0.3, 1e-3, 500, Interpolation::kTrilinear, 4, false};
  DeformOptions deform{0.1, 0.75, 0.3, 1e-3, 3000, Interpolation::kTrilinear, 8, true};
  /// In grid spacings; they set min_displacement_A. The thesis' 1e-3 lets the mapping end while a few vertices still
  /// travel.
  double regularize_min_displacement = 1e-3, deform_min_displacement = 5e-4;
  bool round_trip = false;     ///< map back as well, which takes as long again, and see whether that ends at the start
  double temperature_K = 300;  ///< for converting between kT/e and other units
};

/// The thesis' iteration as it stands, for comparing with its results.
CompareOptions thesis_options();

}  // namespace espdiff
