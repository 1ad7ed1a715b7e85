// map_frames.h: a template mapped onto frames, several beside each other.
#pragma once

#include <cstddef>
#include <functional>

#include "base/error.h"
#include "base/progress.h"
#include "mapping/input.h"

namespace espdiff {

class Engine;
class TemplateMapping;
struct TemplateFrame;

/// The frames of one run. Each thread makes its own template, like `mapping`.
struct FramesToMap {
  Engine& engine;
  TemplateMapping& mapping;  ///< by that engine
  std::size_t n = 0;
  std::size_t n_atoms = 0;       ///< of the template; frames have about as many
  std::size_t bytes_of_map = 0;  ///< of the largest given map; 0 where maps are computed
  /// Called on this thread in the frames' order, while frames before it are mapped.
  std::function<HeldInput(std::size_t)> read;
};

/// How many frames are mapped at a time: as many as the engine has threads, or a few on a GPU; fewer where there are
/// few frames, or where memory does not hold so many.
int frames_at_once(const FramesToMap& frames);

/// Maps all frames. They have the same bits as one by one.
/// @param done   called on this thread for each frame in ascending order; what it throws ends the run
/// @param failed the same for a frame that cannot be read or mapped. Not for Cancelled.
/// @param progress receives the stage of the first frame that is not done, and the fraction of frames done
/// @throws what `done` and `failed` throw, after both were called for all frames before; Cancelled
void map_frames(const FramesToMap& frames, const std::function<void(std::size_t, const TemplateFrame&)>& done,
                const std::function<void(std::size_t, const Error&)>& failed, const Progress& progress);

}  // namespace espdiff
