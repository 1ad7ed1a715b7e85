// surface.h: one molecule's surface and density in its own frame.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "base/types.h"
#include "engine/deform_stage.h"
#include "engine/surface_stage.h"
#include "mapping/surface_summary.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;
struct SurfaceOptions;

/// A molecule's surface in its own frame, for the `surface` verb.
struct SurfaceResult {
  Mesh mesh;                          ///< positions in the molecule's frame
  std::vector<Vec3d> positions;       ///< [vertex] double precision, the molecule's frame
  std::vector<std::int32_t> residue;  ///< [vertex]
  std::vector<float> potential;       ///< [vertex], empty without a map
  PotentialUnit unit = PotentialUnit::kUnknown;
  std::string potential_label;  ///< of a computed potential: "Poisson-Boltzmann, 0.15 mol/l"; empty otherwise
  double outside_map = 0;       ///< fraction of the vertices outside the map, whose potential is NaN
  bool is_vacuum = false;       ///< a computed potential that sees neither water nor a dielectric
  SurfaceSummary summary;
  std::vector<ComponentSummary> components;  ///< all, cavities included
  DeformReport regularize_report;
  std::vector<std::pair<std::string, double>> time_ms;
};
/// @param regularize regularizes the mesh, as for the source of a comparison
SurfaceResult make_surface(Engine& engine, const CompareInput& input, const CompareOptions& options, bool regularize,
                           const Progress& progress);

/// A molecule's density on a lattice along the coordinate axes of its own frame, since VMD's interpolation (1.9.4)
/// supports no other.
Grid make_density(Engine& engine, const Molecule& molecule, const SurfaceOptions& options);

}  // namespace espdiff
