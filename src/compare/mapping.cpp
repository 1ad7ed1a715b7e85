// mapping.cpp: the part of a mapping that has a counterpart.
#include "compare/mapping.h"

#include <algorithm>

#include "engine/engine.h"
#include "engine/handles.h"
#include "engine/surface_stage.h"

namespace espdiff {
namespace {

/// Marks as lost, in the whole, what is marked in the part that is left; returns whether anything was.
bool lose(std::vector<float>& unmatched, const std::vector<float>& marked) {
  bool any = false;
  std::size_t k = 0;
  for (float& flag : unmatched) {
    if (flag != 0 || marked[k++] == 0) continue;
    flag = 1;
    any = true;
  }
  return any;
}

void measure(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue) {
  mapping.fit = engine.fit(mapping.counted, target_atoms, isovalue);
  mapping.to_target = engine.distances(mapping.counted, target, kCounterpartLimit_A);
  mapping.distortion = engine.distortion(mapping.counted_source, mapping.counted, kAreaRatioLimit);
}

/// [triangle of the part] nonzero where it is to be lost.
std::vector<float> faults(Engine& engine, const Mapping& mapping) {
  std::vector<float> marked = engine.download(mapping.fit.corrupt);
  for (const ScalarsPtr& flags : {mapping.fit.flipped, mapping.intersections.intersecting, mapping.to_target.beyond,
                                  mapping.distortion.excessive}) {
    if (flags == nullptr) continue;
    const std::vector<float> other = engine.download(flags);
    std::transform(marked.begin(), marked.end(), other.begin(), marked.begin(),
                   [](float a, float b) { return std::max(a, b); });
  }
  return marked;
}

/// Takes the part of both meshes that is not lost.
void leave_out_unmatched(Engine& engine, Mapping& mapping) {
  const ScalarsPtr unmatched = engine.upload_scalars(mapping.unmatched);
  mapping.counted = engine.without(mapping.mapped, unmatched);
  mapping.counted_source = engine.without(mapping.source, unmatched);
}

}  // namespace

void settle(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue) {
  const bool tells = !mapping.unmatched.empty();
  if (tells) {
    leave_out_unmatched(engine, mapping);
  } else {
    mapping.counted = mapping.mapped;
    mapping.counted_source = mapping.source;
  }
  measure(engine, mapping, target_atoms, target, isovalue);
  mapping.intersections = engine.self_intersections(mapping.counted);
  while (tells && lose(mapping.unmatched, faults(engine, mapping))) {
    leave_out_unmatched(engine, mapping);
    // Without every triangle that was in a pair there is no pair left: only the area that has grown is to be seen
    // again, since it is measured over what lies around.
    mapping.intersections = {};
    measure(engine, mapping, target_atoms, target, isovalue);
  }
}

void drop_closed_cavities(Engine& engine, Mapping& mapping) {
  const std::vector<ComponentSummary> components = engine.components(mapping.source);
  const auto is_cavity = [](const ComponentSummary& component) { return component.volume_A3 < 0; };
  if (std::none_of(components.begin(), components.end(), is_cavity)) return;
  const Mesh source = engine.download(mapping.source);
  std::vector<float> dropped(mapping.unmatched.size()), unmatched;
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    const bool cavity = is_cavity(components[source.component[source.triangles[t][0]]]);
    dropped[t] = cavity && mapping.unmatched[t] != 0 ? 1.0F : 0.0F;
    if (dropped[t] == 0) unmatched.push_back(mapping.unmatched[t]);
  }
  const ScalarsPtr flags = engine.upload_scalars(dropped);
  mapping.source = engine.without(mapping.source, flags);
  // One topology still: what is compared at counterparts shares it.
  mapping.mapped =
      engine.with_positions(mapping.source, engine.download(engine.without(mapping.mapped, flags)).positions);
  mapping.unmatched = std::move(unmatched);
  std::vector<bool> left(source.positions.size(), false);
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    if (dropped[t] != 0) continue;
    for (const std::uint32_t v : source.triangles[t]) left[v] = true;
  }
  std::size_t n = 0;
  for (std::size_t v = 0; v < left.size(); ++v) {
    if (left[v]) mapping.path_length[n++] = mapping.path_length[v];
  }
  mapping.path_length.resize(n);
}

std::vector<std::uint8_t> spread(const std::vector<float>& counted, const std::vector<float>& unmatched) {
  if (unmatched.empty()) return std::vector<std::uint8_t>(counted.begin(), counted.end());
  std::vector<std::uint8_t> whole(unmatched.size(), 0);
  std::size_t k = 0;
  for (std::size_t t = 0; t < unmatched.size(); ++t) {
    if (unmatched[t] == 0) whole[t] = counted[k++] != 0 ? 1 : 0;
  }
  return whole;
}

}  // namespace espdiff
