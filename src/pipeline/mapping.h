// mapping.h: what a mapping gave, on the device, and its part that has a counterpart.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/engine.h"

namespace espdiff {

/// Two meshes of one topology: where each vertex comes from, and where it lies on the target.
struct Mapping {
  MeshPtr source, mapped;
  std::vector<float> lost;  ///< [triangle] nonzero where there is no counterpart; empty where there is one everywhere
  /// The triangles of `mapped` with a counterpart; `mapped` itself where all have one.
  MeshPtr counted_source, counted;
  FitReport fit;  ///< of `counted`
};

/// Fills in `counted` and `fit`. With `lost` not empty, cuts out as well what is off the target's surface, flipped or
/// intersects itself.
void find_fit(Engine& engine, Mapping& mapping, const AtomsPtr& target, float isovalue);

/// [triangle of the whole] from [triangle with a counterpart]; 0 where lost.
std::vector<std::uint8_t> spread(const std::vector<float>& counted, const std::vector<float>& lost);

}  // namespace espdiff
