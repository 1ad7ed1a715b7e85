// sample_outside.h: a potential read at a distance outside a surface, along its normals.
#pragma once

#include <vector>

#include "base/handles.h"
#include "base/types.h"

namespace espdiff {

class Engine;

/// [vertex] of one side's surface.
struct OutsideSamples {
  std::vector<float> values;         ///< NaN outside the map
  std::vector<std::uint8_t> inside;  ///< nonzero where the point lies inside the surface: in a crevice, or another part
};

/// A mesh with each vertex moved by a distance along the outward normal of the atoms' level set.
MeshPtr moved_outside(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue, double offset_A);

/// Samples a map at each vertex moved by a distance along the outward normal of the atoms' level set.
/// @param mesh     common frame, on or near the level set of `atoms`
/// @param offset_A 0 samples the vertices where they are, none of them inside
/// @throws as Engine::sample
OutsideSamples sample_outside(Engine& engine, const GridPtr& map, const MeshPtr& mesh, const AtomsPtr& atoms,
                              float isovalue, double offset_A);

}  // namespace espdiff
