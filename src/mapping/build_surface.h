// build_surface.h: builds a molecule's surface, in the common frame or in its own.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/types.h"
#include "engine/deform_stage.h"
#include "engine/surface_stage.h"
#include "mapping/stage_clock.h"
#include "mapping/surface_summary.h"

namespace espdiff {

struct CompareInput;
struct CompareOptions;
struct SurfaceOptions;

/// Largest projection of a vertex onto the analytic surface, in grid spacings; linear interpolation errs by less than a
/// tenth.
constexpr double kProjectionShare = 0.5;

/// One molecule's surface in the common frame.
struct Surface {
  AtomsPtr atoms;
  double radius_scale = 1;
  GridPtr density;
  MeshPtr mesh;                              // without closed cavities, unless the options keep them
  MeshPtr whole;                             // with closed cavities
  std::vector<ComponentSummary> components;  // all
  SurfaceSummary summary;
};

/// Density, surface, components, projection; adds their times to the clock.
/// @param to_common the molecule's own frame -> the common frame
/// @throws InputError (options, radii), GeometryError (no surface), MemoryError, Cancelled
Surface build_surface(Engine& engine, const Molecule& molecule, const RigidTransform& to_common,
                      const SurfaceOptions& options, const Progress& progress, StageClock& clock);

/// [vertex] the label of the atom with the largest density at the vertex.
/// @param labels [atom] of the molecule, from 0  @param mesh in the common frame
std::vector<std::int32_t> vertex_labels(Engine& engine, const Surface& surface, const MeshPtr& mesh,
                                        const Molecule& molecule, const RigidTransform& to_common,
                                        const std::vector<std::int32_t>& labels);

/// The surface after regularization on its own density (thesis section 3.5.5).
/// @param mesh the surface's `mesh` or `whole`
MeshPtr regularize(Engine& engine, const Surface& surface, const MeshPtr& mesh, const CompareOptions& options,
                   const Progress& progress, DeformReport* report);

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
