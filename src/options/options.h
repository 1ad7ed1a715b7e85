// options.h: all parameters of a comparison.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/input_options.h"
#include "base/molecule/pairing.h"
#include "base/molecule/quantity.h"
#include "engine/deform_stage.h"
#include "engine/morph_stage.h"

namespace espdiff {

/// The field that moves the surface in `deform`: the target's density, the distance where the target is far, or
/// gradient vector flow from the target or from both surfaces.
enum class DeformField { kDensity, kDistance, kGvf, kGvf2 };
DeformField parse_deform_field(const std::string& text);
std::string to_string(DeformField field);
Interpolation parse_interpolation(const std::string& text);

/// The mapping of the source's surface to the target's: by forces in a field of the target (the thesis), or by
/// following the level sets of the density while the atoms move.
enum class Method { kDeform, kMorph };
Method parse_method(const std::string& text);
std::string to_string(Method method);

/// Parameters of a molecule's surface.
struct SurfaceOptions {
  double grid_spacing_A = 1.0;
  double radius_scale = 1.0;
  double isovalue = 0.5;
  bool cavities = false;  ///< keep closed cavities; removed and counted by default
  bool project = true;    ///< move vertices onto the analytic isosurface
};

/// All parameters of a comparison. Defaults are the thesis' values where it has them. Not in the thesis: tangential
/// gains other than 1, the rest shape, the projection onto the exact isosurface, and both min_displacements.
struct CompareOptions {
  InputOptions input;
  SurfaceOptions surface;
  AlignAtoms align = AlignAtoms::kAll;
  std::string domains = "as-needed";  ///< rigid domains to superpose separately, or local motions; see check_domains()
  Method method = Method::kMorph;
  MorphOptions morph;
  double morph_max_edge = 1.4;  ///< in grid spacings; sets MorphOptions::max_edge_A
  DeformField field = DeformField::kDistance;
  double distance_threshold_A = 0.75;
  VectorFlowOptions flow;
  bool subdivide = false;  ///< split edges that deform has stretched, and iterate again; see map_by_deform.h
  DeformOptions regularize{0.1, 0.5, 0.3, 1e-3, 500, Interpolation::kTrilinear, 10, false, 0.7};
  DeformOptions deform{0.1, 0.75, 0.3, 1e-3, 3000, Interpolation::kTrilinear, 8, true, 0};
  /// In grid spacings; they set min_displacement_A. With the thesis' 1e-3 the mapping ends while a few vertices still
  /// move. The regularization's step is the longest that is stable for every rho; it ends at the force of 1e-3 with a
  /// gain of 4 (1e-3 * 10 / 4 / (1 - momentum), and a tenth less): a regularity as good in 0.2 of the iterations.
  double regularize_min_displacement = 7.5e-3, deform_min_displacement = 5e-4;
  /// How far outside the surfaces the potentials are read, each along its own surface's normal, Angstrom. The first one
  /// is what vertices and residues have; metrics are computed for all.
  std::vector<double> offsets_A{0};
  std::vector<FieldRequest> fields;        ///< compared besides the potential
  std::vector<PatchesRequest> patches_of;  ///< fields whose patches in each state are found
  std::string interface;                   ///< "A:B": partners whose complementarity is compared; empty for none
  std::vector<std::string> causes;         ///< readings whose causes are wanted; see causes/reading.h
  /// Share of the source's surface, and of the target's, that has to be trusted; below it a result is not trustworthy.
  double required_share = 0.5;
  bool leave_out_turned = false;  ///< KeptTurns::kNone instead of kNear
  bool scan = false;              ///< for each of them, how a change of each residue's charges would shift it
  int side_chains = 0;            ///< draws of other places of side chains, for each of them; 0 for none
  int side_chain_seed = 1;
  bool round_trip = false;     ///< also map back, which doubles the time, and measure the round-trip error
  bool trust_maps = false;     ///< given maps are taken as they are: what speaks against them does not refuse
  double temperature_K = 300;  ///< for converting between kT/e and other units
};

/// The thesis' original iteration, for comparing with its results.
CompareOptions thesis_options();

}  // namespace espdiff
