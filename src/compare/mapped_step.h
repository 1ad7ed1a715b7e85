// mapped_step.h: one mapping of a step, and what its fit and its slip are judged by.
#pragma once

#include <cstdint>
#include <vector>

#include "base/handles.h"
#include "certificate/result.h"
#include "engine/morph_stage.h"
#include "mapping/build_surface.h"
#include "mapping/mapping.h"
#include "motions/common_frame.h"

namespace espdiff {

struct MappedStep {
  CommonFrame frame;
  std::vector<MovingAtom> paths;  ///< of all atoms from the source to the target; empty if the method needs none
  MorphResult morphed;            ///< by the morph
  Mapping mapping;
  MeshPtr moved;                 ///< the source's surface, moved by its rigid domains
  std::vector<bool> is_matched;  ///< [vertex] whether it lies in a matched triangle
  SurfaceAreas areas;            ///< of the result's surface
  CompareResult result;
};

/// Sets unmatched vertices to NaN.
/// @param is_matched [vertex]
void set_unmatched_to_nan(const std::vector<bool>& is_matched, std::vector<float>& values);

/// Downloads a certified mapping and finds its residues and its slip: fills in the result's surface without normals and
/// potentials, the slip, the area on the same residue, where it is trusted, and the residues' rows without potentials.
/// @param source_surface, target_surface in the common frame  @param kept of why_of_mapping()
void describe(Engine& engine, const Molecule& source, const Molecule& target, const Surface& source_surface,
              const Surface& target_surface, KeptTurns kept, MappedStep& step);

/// Marks the vertices of what turned that lie off the place where it carried them: fills in the surface's `turned`.
/// Nothing is asked of the device where nothing turned.
/// @param mapped_source the source's surface, vertex by vertex that of `surface`, in the common frame
/// @param surface       with positions in the molecules' own frames
void mark_turned(Engine& engine, const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                 const Surface& source_surface, const MeshPtr& mapped_source, const RigidTransform& from_source,
                 MappedSurface& surface);

/// Fills in the normals of the result's surface.
void add_normals(Engine& engine, const Surface& source_surface, const Surface& target_surface, float isovalue,
                 MappedStep& step);

}  // namespace espdiff
