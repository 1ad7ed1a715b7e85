// mapping.cpp: the part of a mapping that has a counterpart.
#include "pipeline/mapping.h"

#include <algorithm>
#include <cstdlib>
#include <cstdio>

namespace espdiff {
namespace {

/// Marks as lost, in the whole, what is marked in the part that is left; returns how many.
std::size_t lose(std::vector<float>& lost, const std::vector<float>& marked) {
  std::size_t n = 0, k = 0;
  for (float& flag : lost) {
    if (flag != 0) continue;
    if (marked[k++] == 0) continue;
    flag = 1;
    ++n;
  }
  return n;
}

}  // namespace

void find_fit(Engine& engine, Mapping& mapping, const AtomsPtr& target, float isovalue) {
  if (mapping.lost.empty()) {
    mapping.counted = mapping.mapped;
    mapping.counted_source = mapping.source;
    mapping.fit = engine.fit(mapping.counted, target, isovalue);
    return;
  }
  const bool verbose = std::getenv("M_VERBOSE") != nullptr;
  for (;;) {
    mapping.counted = engine.without(mapping.mapped, engine.upload_scalars(mapping.lost));
    mapping.fit = engine.fit(mapping.counted, target, isovalue);
    const IntersectionReport meeting = engine.self_intersections(mapping.counted);
    std::vector<float> marked = engine.download(meeting.intersecting);
    const std::vector<float> corrupt = engine.download(mapping.fit.corrupt), flipped = engine.download(mapping.fit.flipped);
    if (verbose)
      std::printf("    cut: area %.1f corrupt %.4f%% flipped %.4f%% pairs %zu\n", mapping.fit.area_A2, 100*mapping.fit.corrupt_area_fraction, 100*mapping.fit.flipped_area_fraction, meeting.n_pairs);
    for (std::size_t t = 0; t < marked.size(); ++t) marked[t] = std::max({marked[t], corrupt[t], flipped[t]});
    if (lose(mapping.lost, marked) == 0) break;
  }
  mapping.counted_source = engine.without(mapping.source, engine.upload_scalars(mapping.lost));
}

std::vector<std::uint8_t> spread(const std::vector<float>& counted, const std::vector<float>& lost) {
  if (lost.empty()) return std::vector<std::uint8_t>(counted.begin(), counted.end());
  std::vector<std::uint8_t> whole(lost.size(), 0);
  std::size_t k = 0;
  for (std::size_t t = 0; t < lost.size(); ++t) {
    if (lost[t] == 0) whole[t] = counted[k++] != 0 ? 1 : 0;
  }
  return whole;
}

}  // namespace espdiff
