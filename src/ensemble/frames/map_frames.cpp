// map_frames.cpp: frames are read by the thread that asked, and mapped by workers.
#include "ensemble/frames/map_frames.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "compare/template_mapping.h"
#include "engine/workers.h"

namespace espdiff {
namespace {

/// A frame from its reading to its end.
struct Place {
  HeldInput input;
  TemplateFrame frame;
  std::optional<Error> error;
};

Workers workers_of(const FramesToMap& frames) {
  // A thread's own template costs about as much as a frame. Inputs wait for their thread, and results for their turn.
  constexpr std::size_t kLeastFramesEach = 2, kWaiting = 2;
  const double bytes_each =
      kBytesOfAtom * static_cast<double>(frames.n_atoms) + static_cast<double>(kWaiting * frames.bytes_of_map);
  return workers_for(frames.engine, std::max<std::size_t>(1, frames.n / kLeastFramesEach), bytes_each);
}

}  // namespace

int frames_at_once(const FramesToMap& frames) { return workers_of(frames).n; }

void map_frames(const FramesToMap& frames, const std::function<void(std::size_t, const TemplateFrame&)>& done,
                const std::function<void(std::size_t, const Error&)>& failed, const Progress& progress) {
  ItemGroups each{frames.n, std::vector<std::size_t>(frames.n)};
  std::iota(each.ends.begin(), each.ends.end(), std::size_t{1});
  std::vector<Place> places(frames.n);
  const auto begin = [&](Engine& of_thread) -> ComputeItem {
    std::shared_ptr<TemplateMapping> own;
    if (&of_thread != &frames.engine) own = frames.mapping.beside(of_thread, {});
    return [&, own](std::size_t i, const Progress& stages) {
      Place& place = places[i];
      if (place.error) return;
      place.frame = (own ? *own : frames.mapping).map(place.input.input, stages);
      place.input = {};
    };
  };
  const auto keep_error = [&](std::size_t i, const Error& error) {
    places[i].error = error;
    places[i].input = {};
  };
  const auto hand_over = [&](std::size_t i) {
    const Place place = std::exchange(places[i], {});
    if (place.error) {
      failed(i, *place.error);
    } else {
      done(i, place.frame);
    }
  };
  const auto supply = [&](std::size_t i) {
    try {
      places[i].input = frames.read(i);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      places[i].error = error;
    }
  };
  compute_items(frames.engine, workers_of(frames), each, begin, keep_error, hand_over, progress, supply);
}

}  // namespace espdiff
