// scene_keys.h: the keys that change a scene.
#pragma once

#include <string>

#include "view/scene.h"

namespace espdiff {

/// Changes a scene as a key of the viewer says. @returns false for a key that changes none
/// @param key   X's name of it, such as "bracketleft"
/// @param limit the upper end of the scale that is shown now
bool change_by_key(Scene& scene, const std::string& key, double limit);

}  // namespace espdiff
