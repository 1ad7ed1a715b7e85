// scene_options.h: the options of a picture, for `render` and `view`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace espdiff {
class AtomicFile;
}

namespace espdiff::cli {

/// A scene file, and the options' changes to it.
struct SceneArguments {
  std::string scene_file, saved_scene;
  std::vector<std::string> range_of;                 ///< results that share the scale
  std::vector<std::function<void(Scene&)>> changes;  ///< of the given options, in order
};

/// @param defaults of the picture, as help names them
void add_scene_options(CLI::App& parser, SceneArguments& arguments, const Scene& defaults = {});

/// Defaults, then the scene file, then the options; then the ranges that it shares with other results.
/// @param surface the result that is drawn, one of those that share the scale
/// @throws IoError, FormatError, InputError
Scene scene_of(const SceneArguments& arguments, const std::string& surface, const Scene& defaults = {});

/// The scene as the file `saved_scene`, for the caller to commit; null where it is not asked for.
/// @throws IoError
std::unique_ptr<AtomicFile> saved_scene_of(const SceneArguments& arguments, const Scene& scene);

}  // namespace espdiff::cli
