// scene_keys.h: the keys of the viewer, and how some of them change a scene.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace espdiff {

/// Changes a scene according to a key of the viewer. @returns false for other keys
/// @param key   X's name of it, such as "bracketleft"
/// @param limit the upper end of the current scale
bool change_by_key(Scene& scene, const std::string& key, double limit);

/// A key of the viewer and what it does, for help and manual.
struct ViewerKey {
  std::string keys, help;
};
std::vector<ViewerKey> viewer_keys();

}  // namespace espdiff
