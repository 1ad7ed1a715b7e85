// scene_keys.h: the keys that change a scene.
#pragma once

#include <string>

#include "scene/scene.h"

namespace espdiff {

/// Changes a scene according to a key of the viewer. @returns false for other keys
/// @param key   X's name of it, such as "bracketleft"
/// @param limit the upper end of the current scale
bool change_by_key(Scene& scene, const std::string& key, double limit);

}  // namespace espdiff
