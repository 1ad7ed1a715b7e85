// input.h: one side of a comparison.
#pragma once

#include <functional>

#include "base/progress.h"
#include "base/types.h"
#include "engine/handles.h"

namespace espdiff {

/// Makes a potential map on the device when it is needed. Sampling uses the method the map was made for, such as its
/// splines (PmeOptions::smooth_samples). In kT/e at the comparison's temperature. `to_map` goes from the common frame
/// into the molecule's own frame, which is the map's.
using MapMaker = std::function<GridPtr(Engine& engine, const RigidTransform& to_map, const Progress& progress)>;

/// One side of a comparison: a molecule with a given map, a computed map, or none. Without maps on both sides only
/// shapes are compared.
struct CompareInput {
  const Molecule* molecule = nullptr;
  const Grid* map = nullptr;
  MapMaker make_map = nullptr;  ///< used instead of `map`
};

}  // namespace espdiff
