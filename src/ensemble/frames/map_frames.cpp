// map_frames.cpp: each worker has a template of its own.
#include "ensemble/frames/map_frames.h"

#include <algorithm>
#include <memory>

#include "compare/template_mapping.h"
#include "engine/read_and_compute.h"

namespace espdiff {
namespace {

Workers workers_of(const FramesToMap& frames) {
  return workers_for_frames(frames.engine, frames.n, frames.n_atoms, frames.bytes_of_map);
}

}  // namespace

int frames_at_once(const FramesToMap& frames) { return workers_of(frames).n; }

void map_frames(const FramesToMap& frames, const std::function<void(std::size_t, const TemplateFrame&)>& done,
                const std::function<void(std::size_t, const Error&)>& failed, const Progress& progress) {
  const auto begin = [&](Engine& of_worker) -> ItemSteps<HeldInput, TemplateFrame>::Compute {
    std::shared_ptr<TemplateMapping> own;
    if (&of_worker != &frames.engine) own = frames.mapping.beside(of_worker, {});
    return [&, own](std::size_t, const HeldInput& frame, const Progress& stages) {
      return (own ? *own : frames.mapping).map(frame.input, stages);
    };
  };
  read_and_compute<HeldInput, TemplateFrame>(frames.engine, workers_of(frames), frames.n,
                                             {frames.read, begin, done, failed}, progress);
}

}  // namespace espdiff
