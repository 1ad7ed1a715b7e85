// viewer.h: the window of `espdiff view`.
#pragma once

#include <string>

#include "scene/scene.h"

namespace espdiff {

/// Opens a window on a comparison and returns when it is closed. Picked points are also printed to standard output.
/// @param saved_prefix pictures and scenes are saved as PREFIX.png and PREFIX.json, then PREFIX-2.png and so on
/// @throws as render_surface(); Error of class kCancelled within 0.1 s of a request to cancel (CancelRequest)
void run_viewer(const std::string& vtp_path, const Scene& scene, const std::string& saved_prefix);

}  // namespace espdiff
