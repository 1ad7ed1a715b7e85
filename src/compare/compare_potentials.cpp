// compare_potentials.cpp: samples, what is excluded from each metric, and the metrics.
#include "compare/compare_potentials.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "compare/options.h"
#include "compare/sample_outside.h"
#include "compare/side_maps.h"
#include "compare/slip.h"
#include "engine/engine.h"

namespace espdiff {
namespace {

struct Comparison {
  Engine& engine;
  const PotentialSide &source, &target;
  float isovalue = 0;
  PotentialUnit unit = PotentialUnit::kUnknown;
  MappedStep& step;
  ScalarsPtr path_length{};
  std::vector<float> excluded{};  ///< [triangle] that count nowhere: corrupt or unmatched

  /// Both potentials at one distance outside the surfaces, NaN where a vertex does not count; says in `counted` why.
  std::pair<std::vector<float>, std::vector<float>> sample_both(OffsetMetrics& counted) const {
    const std::vector<bool>& kept = step.is_matched;
    OutsideSamples at_source = sample_outside(engine, source.map, step.mapping.source, source.atoms, isovalue,
                                              counted.offset_A),
                   at_target = sample_outside(engine, target.map, step.mapping.mapped, target.atoms, isovalue,
                                              counted.offset_A);
    counted.n_outside_source_map = count_outside(source.input, at_source.values, kept);
    counted.n_outside_target_map = count_outside(target.input, at_target.values, kept);
    for (std::size_t v = 0; v < kept.size(); ++v) {
      if (at_source.inside[v] != 0) at_source.values[v] = std::numeric_limits<float>::quiet_NaN();
      if (at_target.inside[v] != 0) at_target.values[v] = std::numeric_limits<float>::quiet_NaN();
      counted.n_inside_source += kept[v] && at_source.inside[v] != 0 ? 1 : 0;
      counted.n_inside_target += kept[v] && at_target.inside[v] != 0 ? 1 : 0;
    }
    return {std::move(at_source.values), std::move(at_target.values)};
  }

  /// @param left_out [triangle] nonzero where it does not count; empty includes all
  Metrics metrics(const ScalarsPtr& at_source, const ScalarsPtr& at_target, const std::vector<float>& left_out) const {
    return engine.compare(step.moved, step.mapping.mapped, at_source, at_target,
                          left_out.empty() ? nullptr : engine.upload_scalars(left_out), path_length);
  }

  std::vector<float> slipped_or_excluded() const {
    std::vector<float> slipped = slipped_triangles(step.result.surface);
    for (std::size_t t = 0; t < slipped.size(); ++t) slipped[t] = std::max(slipped[t], excluded[t]);
    return slipped;
  }

  /// The metrics of a part at one distance.
  void compare_part(const ScalarsPtr& at_source, const ScalarsPtr& at_target, const std::vector<float>& outside,
                    double offset_A, CompareResult& part) const {
    std::vector<float> flags = outside, unmatched = outside;
    for (std::size_t t = 0; t < flags.size(); ++t) flags[t] = std::max(flags[t], excluded[t]);
    for (std::size_t t = 0; t < step.mapping.unmatched.size(); ++t)
      unmatched[t] = std::max(unmatched[t], step.mapping.unmatched[t]);
    OffsetMetrics at;
    at.offset_A = offset_A;
    at.metrics = metrics(at_source, at_target, flags);
    part.has_potential = true;
    part.unit = unit;
    part.by_offset.push_back(at);
    if (part.by_offset.size() > 1) return;
    part.metrics = at.metrics;
    part.metrics_all = metrics(at_source, at_target, unmatched);
  }

  void compare_at(double offset_A, const std::vector<MeasuredPart>& parts) const {
    CompareResult& result = step.result;
    MappedSurface& s = result.surface;
    OffsetMetrics at;
    at.offset_A = offset_A;
    auto [of_source, of_target] = sample_both(at);
    const ScalarsPtr at_source = engine.upload_scalars(of_source), at_target = engine.upload_scalars(of_target);
    at.metrics = metrics(at_source, at_target, excluded);
    result.by_offset.push_back(at);
    for (const MeasuredPart& part : parts)
      compare_part(at_source, at_target, part.place.outside, at.offset_A, *part.result);
    if (result.by_offset.size() > 1) return;
    result.metrics = at.metrics;
    result.n_outside_source_map = at.n_outside_source_map;
    result.n_outside_target_map = at.n_outside_target_map;
    result.metrics_all = metrics(at_source, at_target, step.mapping.unmatched);
    if (!s.slip.empty()) result.metrics_without_slip = metrics(at_source, at_target, slipped_or_excluded());
    s.potential_source = std::move(of_source);
    s.potential_target = std::move(of_target);
    set_unmatched_to_nan(step.is_matched, s.potential_target);
  }
};

}  // namespace

void compare_potentials(Engine& engine, const PotentialSide& source, const PotentialSide& target,
                        const CompareOptions& options, PotentialUnit unit, const std::vector<MeasuredPart>& parts,
                        MappedStep& step) {
  Comparison comparison{engine, source, target, static_cast<float>(options.surface.isovalue), unit, step};
  const MappedSurface& s = step.result.surface;
  comparison.path_length = engine.upload_scalars(step.mapping.path_length);
  comparison.excluded.assign(s.corrupt.begin(), s.corrupt.end());
  for (std::size_t t = 0; t < step.mapping.unmatched.size(); ++t)
    comparison.excluded[t] = std::max(comparison.excluded[t], step.mapping.unmatched[t]);
  step.result.unit = unit;
  step.result.has_potential = true;
  for (const double offset_A : options.offsets_A) comparison.compare_at(offset_A, parts);
}

}  // namespace espdiff
