// mapping.cpp: the matched part of a mapping.
#include "compare/mapping.h"

#include <algorithm>

#include "base/handles.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"

namespace espdiff {
namespace {

/// Copies the flags of the matched part to the full mesh; returns whether any was new.
bool copy_flags(std::vector<float>& unmatched, const std::vector<float>& marked) {
  bool any = false;
  std::size_t k = 0;
  for (float& flag : unmatched) {
    if (flag != 0 || marked[k++] == 0) continue;
    flag = 1;
    any = true;
  }
  return any;
}

/// Fit and distances, which each triangle has by itself.
void measure(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue) {
  mapping.fit = engine.fit(mapping.matched, target_atoms, isovalue);
  mapping.to_target = engine.distances(mapping.matched, target, kMatchLimit_A);
}

void measure_distortion(Engine& engine, Mapping& mapping) {
  mapping.distortion = engine.distortion(mapping.matched_source, mapping.matched, kAreaRatioLimit);
}

/// [triangle of the matched part] nonzero if it must be removed.
std::vector<float> invalid_triangles(Engine& engine, const Mapping& mapping) {
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

/// Extracts the matched part of both meshes.
void extract_matched(Engine& engine, Mapping& mapping) {
  const ScalarsPtr unmatched = engine.upload_scalars(mapping.unmatched);
  mapping.matched = engine.without(mapping.mapped, unmatched);
  mapping.matched_source = engine.without(mapping.source, unmatched);
}

}  // namespace

void find_matched_part(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target,
                       float isovalue) {
  const bool has_flags = !mapping.unmatched.empty();
  if (has_flags) {
    extract_matched(engine, mapping);
  } else {
    mapping.matched = mapping.mapped;
    mapping.matched_source = mapping.source;
  }
  measure(engine, mapping, target_atoms, target, isovalue);
  measure_distortion(engine, mapping);
  mapping.intersections = engine.self_intersections(mapping.matched);
  if (!has_flags || !copy_flags(mapping.unmatched, invalid_triangles(engine, mapping))) return;
  // Only the area growth depends on a triangle's surroundings and must be checked again: whatever fitted, fits still.
  mapping.intersections = {};
  do {
    extract_matched(engine, mapping);
    measure_distortion(engine, mapping);
  } while (copy_flags(mapping.unmatched, engine.download(mapping.distortion.excessive)));
  measure(engine, mapping, target_atoms, target, isovalue);
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
  // Both meshes keep one topology, which comparisons of potentials rely on.
  mapping.mapped =
      engine.with_positions(mapping.source, engine.download_positions(engine.without(mapping.mapped, flags)));
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

std::vector<std::uint8_t> to_full_mesh(const std::vector<float>& matched, const std::vector<float>& unmatched) {
  if (unmatched.empty()) return std::vector<std::uint8_t>(matched.begin(), matched.end());
  std::vector<std::uint8_t> whole(unmatched.size(), 0);
  std::size_t k = 0;
  for (std::size_t t = 0; t < unmatched.size(); ++t) {
    if (unmatched[t] == 0) whole[t] = matched[k++] != 0 ? 1 : 0;
  }
  return whole;
}

}  // namespace espdiff
