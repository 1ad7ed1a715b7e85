// input.h: one side of a comparison.
#pragma once

#include <functional>
#include <memory>

#include "base/handles.h"
#include "base/molecule/surface_parts.h"
#include "base/progress.h"
#include "base/types.h"
#include "field/field_side.h"

namespace espdiff {

struct MadeMap;

/// What a computed map is made with, and what for.
struct MapRequest {
  /// A potential that this one may resemble, in the same common frame, such as the source's: an iteration may start
  /// from it; null where there is none.
  GridPtr before = nullptr;
  bool for_readings = false;  ///< Engine::contributions() is asked of it: what that needs of the solution is kept
  double reach_A = 0;         ///< how far outside the surface it is read
};

/// Makes a potential where it is needed, on the device: sampled there in whatever way it was made for, such as by its
/// splines (PmeOptions::smooth_samples). In kT/e at the comparison's temperature. `to_map` is the way from the common
/// frame into the molecule's own.
using MapMaker = std::function<MadeMap(Engine& engine, const RigidTransform& to_map, const MapRequest& request,
                                       const Progress& progress)>;

/// One side of a comparison: a molecule with a given map, a computed map, or none. Without maps on both sides only
/// shapes are compared.
struct CompareInput {
  const Molecule* molecule = nullptr;
  const Grid* map = nullptr;
  MapMaker make_map = nullptr;  ///< used instead of `map`
  SurfaceParts parts{};         ///< of the source: results are given for them as well
  FieldInput fields{};          ///< what its fields are made of besides
};

/// One of many states, and what keeps its molecule and map in memory: nothing where they stay there anyway.
struct HeldInput {
  CompareInput input;
  std::shared_ptr<const void> held{};
};

}  // namespace espdiff
