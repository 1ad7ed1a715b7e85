// local_rotations.h: the rotation of each atom's surroundings, for the morph.
#pragma once

#include <vector>

#include "base/progress.h"
#include "engine/morph_stage.h"

namespace espdiff {

/// Sets own_rotation of every path: the best-fit rotation of the atoms near it at both ends and of its rigid domain,
/// weighted towards the nearest. Groups that rotate relative to their domain thus rotate the surface too; otherwise the
/// surface, which lies beside the atoms, would lag behind and slide. The reverse path rotates by the inverse.
/// @throws Cancelled
void set_local_rotations(std::vector<MovingAtom>& paths, const Progress& progress = {});

}  // namespace espdiff
