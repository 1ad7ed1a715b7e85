// compare_potentials.cpp: samples, what is excluded from each metric, and the metrics.
#include "compare/compare_potentials.h"

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
  OutsideSamples at_source = sample_outside(engine, source.map, step.mapping.source, source.atoms, isovalue, offset_A),
                 at_target = sample_outside(engine, target.map, step.mapping.mapped, target.atoms, isovalue, offset_A);
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
  MappedStep& step;
  ScalarsPtr path_length{};
  std::vector<float> untrusted{};  ///< [triangle]

  /// @param left_out [triangle] nonzero where it does not count; empty includes all
  Metrics metrics(const ScalarsPtr& at_source, const ScalarsPtr& at_target, const std::vector<float>& left_out) const {
    return engine.compare(step.moved, step.mapping.mapped, at_source, at_target,
                          left_out.empty() ? nullptr : engine.upload_scalars(left_out), path_length);
  }

  /// The metrics of a part at one distance.
  void compare_part(const ScalarsPtr& at_source, const ScalarsPtr& at_target, const std::vector<float>& outside,
                    double offset_A, CompareResult& part) const {
    std::vector<float> flags = outside, unmatched = outside;
    for (std::size_t t = 0; t < flags.size(); ++t) flags[t] = std::max(flags[t], untrusted[t]);
    for (std::size_t t = 0; t < step.mapping.unmatched.size(); ++t)
      unmatched[t] = std::max(unmatched[t], step.mapping.unmatched[t]);
    OffsetMetrics at;
    at.offset_A = offset_A;
    at.metrics = metrics(at_source, at_target, flags);
    part.has_potential = true;
    part.unit = step.result.unit;
    part.by_offset.push_back(at);
    if (part.by_offset.size() > 1) return;
    part.metrics = at.metrics;
    part.metrics_all = metrics(at_source, at_target, unmatched);
  }

  void compare_at(const PotentialSamples& samples, const std::vector<MeasuredPart>& parts) const {
    CompareResult& result = step.result;
    OffsetMetrics at = samples.counted;
    const ScalarsPtr at_source = engine.upload_scalars(samples.source),
                     at_target = engine.upload_scalars(samples.target);
    at.metrics = metrics(at_source, at_target, untrusted);
    result.by_offset.push_back(at);
    for (const MeasuredPart& part : parts)
      compare_part(at_source, at_target, part.place.outside, at.offset_A, *part.result);
    if (result.by_offset.size() > 1) return;
    result.metrics = at.metrics;
    result.metrics_all = metrics(at_source, at_target, step.mapping.unmatched);
  }
};

}  // namespace

std::vector<PotentialSamples> sample_potentials(Engine& engine, const PotentialSide& source,
                                                const PotentialSide& target, const CompareOptions& options,
                                                PotentialUnit unit, MappedStep& step) {
  std::vector<PotentialSamples> all;
  for (const double offset_A : options.offsets_A)
    all.push_back(sample_both(engine, source, target, static_cast<float>(options.surface.isovalue), offset_A, step));
  CompareResult& result = step.result;
  const PotentialSamples& first = all.front();
  result.unit = unit;
  result.has_potential = true;
  result.n_outside_source_map = first.counted.n_outside_source_map;
  result.n_outside_target_map = first.counted.n_outside_target_map;
  result.surface.potential_source = first.source;
  result.surface.potential_target = first.target;
  set_unmatched_to_nan(step.is_matched, result.surface.potential_target);
  return all;
}

void compare_potentials(Engine& engine, const std::vector<PotentialSamples>& samples,
                        const std::vector<MeasuredPart>& parts, MappedStep& step) {
  const Comparison comparison{engine, step, engine.upload_scalars(step.mapping.path_length),
                              untrusted_triangles(step.result.surface)};
  for (const PotentialSamples& at : samples) comparison.compare_at(at, parts);
}

}  // namespace espdiff
