// mapping.cpp: the matched part of a mapping.
#include "mapping/mapping.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/handles.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"

namespace espdiff {
namespace {

/// Copies a reason of the matched part to the full mesh, where there is none yet.
/// @param matched [triangle] of the full mesh: its place in the matched part, or -1
void set_reason(Engine& engine, const ScalarsPtr& flags, Removal reason, const std::vector<std::ptrdiff_t>& matched,
                std::vector<Removal>& removed_for) {
  if (flags == nullptr) return;
  const std::vector<float> marked = engine.download(flags);
  for (std::size_t t = 0; t < removed_for.size(); ++t) {
    if (matched[t] >= 0 && removed_for[t] == Removal::kNone && marked[static_cast<std::size_t>(matched[t])] != 0)
      removed_for[t] = reason;
  }
}

/// [triangle] its place in the matched part, -1 if it is unmatched.
std::vector<std::ptrdiff_t> places_in_matched(const std::vector<float>& unmatched) {
  std::vector<std::ptrdiff_t> places;
  places.reserve(unmatched.size());
  std::ptrdiff_t n = 0;
  for (const float flag : unmatched) places.push_back(flag != 0 ? -1 : n++);
  return places;
}

/// Makes triangles unmatched that have a reason; returns whether any was not yet.
bool remove_marked(Mapping& mapping) {
  bool any = false;
  for (std::size_t t = 0; t < mapping.unmatched.size(); ++t) {
    if (mapping.unmatched[t] != 0 || mapping.removed_for[t] == Removal::kNone) continue;
    mapping.unmatched[t] = 1;
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

void mark_faults(Engine& engine, Mapping& mapping) {
  const std::vector<std::ptrdiff_t> places = places_in_matched(mapping.unmatched);
  for (const auto& [flags, reason] :
       {std::pair(mapping.intersections.intersecting, Removal::kIntersecting),
        std::pair(mapping.fit.flipped, Removal::kFlipped), std::pair(mapping.fit.corrupt, Removal::kCorrupt),
        std::pair(mapping.to_target.beyond, Removal::kFar), std::pair(mapping.distortion.excessive, Removal::kGrown)})
    set_reason(engine, flags, reason, places, mapping.removed_for);
}

void mark_growth(Engine& engine, Mapping& mapping) {
  set_reason(engine, mapping.distortion.excessive, Removal::kGrown, places_in_matched(mapping.unmatched),
             mapping.removed_for);
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
    mapping.removed_for.clear();
    for (const float flag : mapping.unmatched)
      mapping.removed_for.push_back(flag != 0 ? Removal::kTorn : Removal::kNone);
    extract_matched(engine, mapping);
  } else {
    mapping.matched = mapping.mapped;
    mapping.matched_source = mapping.source;
  }
  measure(engine, mapping, target_atoms, target, isovalue);
  measure_distortion(engine, mapping);
  mapping.intersections = engine.self_intersections(mapping.matched);
  if (!has_flags) return;
  mark_faults(engine, mapping);
  if (!remove_marked(mapping)) return;
  // Only the area growth depends on a triangle's surroundings and must be checked again: whatever fitted, fits still,
  // and keeps its distances.
  const MeshPtr first = mapping.matched;
  mapping.intersections = {};
  do {
    extract_matched(engine, mapping);
    measure_distortion(engine, mapping);
    mark_growth(engine, mapping);
  } while (remove_marked(mapping));
  std::vector<float> removed;  // [triangle of the first matched part]
  for (std::size_t t = 0; t < mapping.unmatched.size(); ++t) {
    if (mapping.removed_for[t] != Removal::kTorn) removed.push_back(mapping.unmatched[t]);
  }
  const ScalarsPtr flags = engine.upload_scalars(removed);
  mapping.fit = engine.fit_without(mapping.matched, mapping.fit, flags);
  mapping.to_target = engine.distances_without(mapping.matched, first, mapping.to_target, flags, kMatchLimit_A);
}

MeshPtr what_is_left(Engine& engine, const MeshPtr& mesh, const std::vector<float>& excluded) {
  if (std::all_of(excluded.begin(), excluded.end(), [](float flag) { return flag != 0; })) return nullptr;
  return engine.without(mesh, engine.upload_scalars(excluded));
}

Mapping part_of_mapping(Engine& engine, const Mapping& mapping, const std::vector<float>& outside,
                        const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue) {
  std::vector<float> excluded = outside;
  for (std::size_t t = 0; t < mapping.unmatched.size(); ++t) excluded[t] = std::max(excluded[t], mapping.unmatched[t]);
  Mapping part;
  part.source = what_is_left(engine, mapping.source, outside);
  part.matched = what_is_left(engine, mapping.mapped, excluded);
  part.matched_source = what_is_left(engine, mapping.source, excluded);
  if (part.matched == nullptr) return part;
  measure(engine, part, target_atoms, target, isovalue);
  measure_distortion(engine, part);
  part.intersections = engine.self_intersections(part.matched);
  return part;
}

void drop_closed_cavities(Engine& engine, Mapping& mapping) {
  const std::vector<ComponentSummary> components = engine.components(mapping.source);
  const auto is_cavity = [](const ComponentSummary& component) { return component.volume_A3 < 0; };
  if (std::none_of(components.begin(), components.end(), is_cavity)) return;
  const Mesh source = engine.download(mapping.source);
  std::vector<float> dropped(mapping.unmatched.size()), unmatched;
  std::vector<Removal> removed_for;
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    const bool cavity = is_cavity(components[source.component[source.triangles[t][0]]]);
    dropped[t] = cavity && mapping.unmatched[t] != 0 ? 1.0F : 0.0F;
    if (dropped[t] != 0) continue;
    unmatched.push_back(mapping.unmatched[t]);
    removed_for.push_back(mapping.removed_for[t]);
  }
  const ScalarsPtr flags = engine.upload_scalars(dropped);
  mapping.source = engine.without(mapping.source, flags);
  // Both meshes keep one topology, which comparisons of potentials rely on.
  mapping.mapped =
      engine.with_positions(mapping.source, engine.download_positions(engine.without(mapping.mapped, flags)));
  mapping.unmatched = std::move(unmatched);
  mapping.removed_for = std::move(removed_for);
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

DistanceSummary numbers_of(DistanceSummary summary) {
  summary.distances = nullptr;
  return summary;
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
