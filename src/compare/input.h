// input.h: one side of a comparison.
#pragma once

#include <functional>

#include "base/progress.h"
#include "base/types.h"
#include "engine/handles.h"

namespace espdiff {

/// Makes a potential map where it is needed, on the device: sampled there in whatever way the map was made for, such as
/// by its splines (PmeOptions::smooth_samples). In kT/e at the comparison's temperature. `to_map` is the way from the
/// common frame into the molecule's own, which is the map's.
using MapMaker = std::function<GridPtr(Engine& engine, const RigidTransform& to_map, const Progress& progress)>;

/// One side of a comparison, with a map that is given, or one that is computed, or none. Maps may be absent on both
/// sides: then shapes are compared only.
struct CompareInput {
  const Molecule* molecule = nullptr;
  const Grid* map = nullptr;
  MapMaker make_map = nullptr;  ///< instead of `map`
};

}  // namespace espdiff
