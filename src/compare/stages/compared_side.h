// compared_side.h: one side of a step, as its stages read it.
#pragma once

#include <vector>

#include "field/field.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"

namespace espdiff {

/// The fields of one state, made before the work; as many as the options name.
using StateFields = std::vector<StateField>;

/// One side of a step; all in the common frame.
struct ComparedSide {
  CompareInput input;
  StateFields fields{};
  MadeMap map{};  ///< without `map` where there is none
  Surface surface{};
};

}  // namespace espdiff
