// local_rotations.h: how far each atom's surroundings turn on their way, for the morph.
#pragma once

#include <vector>

#include "engine/morph_stage.h"

namespace espdiff {

/// Sets own_rotation of every way: the best rotation of the atoms that are near it at both ends and of its rigid
/// domain, those nearest counting most. What turns as a whole beside its domain takes the surface with it; without this
/// the surface, which lies beside the atoms, would be left behind and slide. The way back turns by the inverse.
void set_local_rotations(std::vector<MovingAtom>& paths);

}  // namespace espdiff
