// compare_potentials.cpp: samples, what is excluded from each metric, and the metrics.
#include "compare/stages/compare_potentials.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "certificate/trusted_area.h"
#include "engine/engine.h"
#include "mapping/sample_outside.h"
#include "mapping/side_maps.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// [vertex] both potentials at one distance outside the surfaces, NaN where a vertex does not count; says in `counted`
/// why.
PotentialSamples sample_both(Engine& engine, const PotentialSide& source, const PotentialSide& target, float isovalue,
                             double offset_A, const MappedStep& step) {
  const std::vector<bool>& kept = step.is_matched;
  PotentialSamples both;
  OffsetMetrics& counted = both.counted;
  counted.offset_A = offset_A;
  OutsideSamples at_source =
                     sample_outside(engine, source.map, step.mapping.source, source.surface.atoms, isovalue, offset_A),
                 at_target =
                     sample_outside(engine, target.map, step.mapping.mapped, target.surface.atoms, isovalue, offset_A);
  counted.n_outside_source_map = count_outside(source.input, at_source.values, kept);
  counted.n_outside_target_map = count_outside(target.input, at_target.values, kept);
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (at_source.inside[v] != 0) at_source.values[v] = std::numeric_limits<float>::quiet_NaN();
    if (at_target.inside[v] != 0) at_target.values[v] = std::numeric_limits<float>::quiet_NaN();
    counted.n_inside_source += kept[v] && at_source.inside[v] != 0 ? 1 : 0;
    counted.n_inside_target += kept[v] && at_target.inside[v] != 0 ? 1 : 0;
  }
  both.source = std::move(at_source.values);
  both.target = std::move(at_target.values);
  return both;
}

struct Comparison {
  Engine& engine;
  const MappedStep& step;
  ScalarsPtr path_length{};
  std::vector<float> untrusted{};  ///< [triangle]

  /// @param left_out [triangle] nonzero where it does not count; empty includes all
  Metrics metrics(const ScalarsPtr& at_source, const ScalarsPtr& at_target, const std::vector<float>& left_out) const {
    return engine.compare(step.moved, step.mapping.mapped, at_source, at_target,
                          left_out.empty() ? nullptr : engine.upload_scalars(left_out), path_length);
  }

  /// Adds the metrics at one distance; at the first, those of all area too.
  /// @param outside [triangle] nonzero where it does not belong to the part; empty for the whole
  void add(const PotentialSamples& samples, const ScalarsPtr& at_source, const ScalarsPtr& at_target,
           const std::vector<float>& outside, PotentialComparison& comparison) const {
    const auto without = [&](std::vector<float> left_out) {
      if (left_out.empty()) return outside;
      for (std::size_t t = 0; t < outside.size(); ++t) left_out[t] = std::max(left_out[t], outside[t]);
      return left_out;
    };
    OffsetMetrics at;
    if (outside.empty()) at = samples.counted;
    at.offset_A = samples.counted.offset_A;
    at.metrics = metrics(at_source, at_target, without(untrusted));
    comparison.compared = true;
    comparison.by_offset.push_back(at);
    if (comparison.by_offset.size() > 1) return;
    comparison.metrics = at.metrics;
    comparison.metrics_all = metrics(at_source, at_target, without(step.mapping.unmatched));
  }
};

}  // namespace

std::vector<PotentialSamples> sample_potentials(Engine& engine, const PotentialSide& source,
                                                const PotentialSide& target, const CompareOptions& options,
                                                const MappedStep& step) {
  std::vector<PotentialSamples> all;
  for (const double offset_A : options.offsets_A)
    all.push_back(sample_both(engine, source, target, static_cast<float>(options.surface.isovalue), offset_A, step));
  return all;
}

PotentialComparison compare_potentials(Engine& engine, const std::vector<PotentialSamples>& samples, PotentialUnit unit,
                                       const MappedStep& step, const MappedSurface& surface,
                                       std::vector<MeasuredPart>& parts) {
  const Comparison comparison{engine, step, engine.upload_scalars(step.mapping.path_length),
                              untrusted_triangles(surface)};
  PotentialComparison whole;
  whole.unit = unit;
  for (const PotentialSamples& at : samples) {
    const ScalarsPtr at_source = engine.upload_scalars(at.source), at_target = engine.upload_scalars(at.target);
    comparison.add(at, at_source, at_target, {}, whole);
    for (MeasuredPart& part : parts) {
      part.result.potential.unit = unit;
      comparison.add(at, at_source, at_target, part.place.outside, part.result.potential);
    }
  }
  if (samples.empty()) return whole;
  whole.n_outside_source_map = samples.front().counted.n_outside_source_map;
  whole.n_outside_target_map = samples.front().counted.n_outside_target_map;
  return whole;
}

}  // namespace espdiff
