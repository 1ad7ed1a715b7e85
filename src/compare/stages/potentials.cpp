// potentials.cpp: checks of two potentials, their samples and metrics, and how residues agree with their own surfaces.
#include "compare/stages/potentials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "align/paired_residues.h"
#include "base/not_a_number.h"
#include "base/text/short_numbers.h"
#include "certificate/own_potentials.h"
#include "certificate/residue_rows.h"
#include "certificate/trusted_area.h"
#include "engine/engine.h"
#include "input_checks/map_warnings.h"
#include "mapping/sample_outside.h"
#include "mapping/side_maps.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// [vertex] both potentials at one distance outside the surfaces, NaN where a vertex does not count; says in `counted`
/// why.
PotentialSamples sample_both(Engine& engine, const ComparedSide& source, const ComparedSide& target, float isovalue,
                             double offset_A, const MappedStep& step) {
  const std::vector<bool>& kept = step.is_matched;
  PotentialSamples both;
  OffsetMetrics& counted = both.counted;
  counted.offset_A = offset_A;
  OutsideSamples at_source = sample_outside(engine, source.map.map, step.mapping.source, source.surface.atoms, isovalue,
                                            offset_A),
                 at_target = sample_outside(engine, target.map.map, step.mapping.mapped, target.surface.atoms, isovalue,
                                            offset_A);
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

/// [residue] a molecule's potentials on its own surface, at the first of the offsets.
std::vector<OwnPotential> own_on(const StatesToMap& states, const ComparedSide& side,
                                 const std::vector<std::int32_t>& partner_of) {
  Engine& engine = states.engine;
  const MeshPtr& mesh = side.surface.mesh;
  const AtomsPtr& atoms = side.surface.atoms;
  OutsideSamples samples =
      sample_outside(engine, side.map.map, mesh, atoms, states.isovalue(), states.options.offsets_A.front());
  for (std::size_t v = 0; v < samples.values.size(); ++v) {
    if (samples.inside[v] != 0) samples.values[v] = static_cast<float>(kNaN);
  }
  return own_potentials(engine.download_shape(mesh), engine.vertex_residues(mesh, atoms), samples.values, partner_of);
}

/// How much the residues' potentials differ between two meshes of one surface, the source's: what the grids alone make
/// of no difference at all.
double noise_of_residues(const StatesToMap& states, const ComparedSide& source, const std::vector<OwnPotential>& own,
                         const std::vector<std::int32_t>& target_of, std::vector<ResidueRow> rows) {
  std::vector<std::int32_t> itself(target_of.size());
  for (std::size_t r = 0; r < itself.size(); ++r) itself[r] = target_of[r] < 0 ? -1 : static_cast<std::int32_t>(r);
  set_own_differences(rows, own, own_on(states, source, target_of), itself);
  return rms_own_difference(rows);
}

/// Whether both states have the same atoms at the same places with the same charges, and the potentials that follow.
bool is_one_state(const StatesToMap& states, const std::vector<ResidueRow>& rows, double rms_potential) {
  constexpr double kRounding_A = 1e-4, kRoundingShare = 1e-3;
  const Molecule &a = states.source, &b = states.target;
  return a.size() == b.size() && states.alignment.pairing.pairs.size() == a.size() && a.charges == b.charges &&
         a.radii == b.radii && states.alignment.rmsd_A <= kRounding_A &&
         std::none_of(rows.begin(), rows.end(), [&](const ResidueRow& row) {
           return std::fabs(row.mean_signed_difference) > kRoundingShare * rms_potential;
         });
}

Warning one_state_warning() {
  return {
      "source and target have the same atoms at the same places with the same charges: every difference is zero but "
      "for rounding",
      false};
}

Warning noise_warning(double differences, double noise, PotentialUnit unit) {
  return {"the residues' potentials differ by " + short_number(differences) + " " + to_string(unit) +
              " (rms) between the states, and by " + short_number(noise) +
              " between two meshes of the source's surface: their correlation is one of noise "
              "with noise and was not judged",
          false};
}

}  // namespace

PotentialFindings check_potentials(const StatesToMap& states, const CommonFrame& frame, const CompareInput& source,
                                   const CompareInput& target, std::shared_ptr<const MapReferences>& references,
                                   ComparedMaps& maps, const Progress& progress) {
  const CompareOptions& options = states.options;
  const auto references_of = [&](const CompareInput& side, const Surface& surface, const RigidTransform& to_common) {
    return std::make_shared<const MapReferences>(states.engine, *side.molecule, to_common, surface, states.isovalue(),
                                                 options.temperature_K, progress);
  };
  PotentialFindings found;
  std::vector<Warning> refusing;  // unless the options trust maps
  const auto check = [&](const char* role, const CompareInput& side, const MapReferences& of_side,
                         std::shared_ptr<const MapCheck>& outcome) {
    for (Warning& warning : map_warnings(role, *side.map, of_side, options.temperature_K, outcome))
      refusing.push_back(std::move(warning));
    if (!outcome) found.not_checked.emplace_back(std::string("map_of_") + role);
  };
  std::shared_ptr<const MapReferences> of_target;
  if (source.map != nullptr) {
    if (!references) references = references_of(source, states.source_surface, frame.from_source);
    check("source", source, *references, maps.source_check);
  }
  if (target.map != nullptr) {
    of_target = references_of(target, states.target_surface, frame.from_target);
    check("target", target, *of_target, maps.target_check);
  }
  if (source.map != nullptr && target.map != nullptr)
    pair_warnings(source, target, references.get(), of_target.get(), maps, refusing);
  if (!options.trust_maps) refuse_vacuum_against_solvent(maps);
  for (Warning& warning : kind_warnings(maps)) refusing.push_back(std::move(warning));
  for (Warning& warning : refusing) {
    warning.refuses = warning.refuses && !options.trust_maps;
    found.warnings.push_back(std::move(warning));
  }
  for (Warning& warning : water_warnings(maps)) found.warnings.push_back(std::move(warning));
  return found;
}

std::vector<PotentialSamples> sample_potentials(Engine& engine, const ComparedSide& source, const ComparedSide& target,
                                                const CompareOptions& options, const MappedStep& step) {
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

ResidueAgreement check_residues_of(const StatesToMap& states, const ComparedSide& source, const ComparedSide& target,
                                   PotentialUnit unit, const MappedStep& step,
                                   const std::vector<std::int32_t>& target_of, MappedSurface& surface,
                                   std::vector<ResidueRow> rows) {
  ResidueAgreement agreement;
  const bool has_potential = target.map.map != nullptr;
  if (!has_potential || states.alignment.pairing.pairs.empty()) {
    for (ResidueRow& row : rows) row.own_difference = row.own_area_A2 = kNaN;
    agreement.is_not_checked = has_potential;
    agreement.rows = std::move(rows);
    return agreement;
  }
  const std::vector<OwnPotential> own = own_potentials(states.engine.download_shape(step.mapping.source),
                                                       surface.residue, surface.potential_source, target_of);
  const std::vector<std::int32_t> source_of = source_residues(target_of, states.target.residues.size());
  const std::vector<OwnPotential> own_on_target = own_on(states, target, source_of);
  set_own_differences(rows, own, own_on_target, target_of);
  const std::vector<std::uint8_t> disagree = disagreeing_residues(rows, own);
  const auto n_disagreeing = static_cast<std::size_t>(std::count(disagree.begin(), disagree.end(), 1));
  if (n_disagreeing > 0) {
    mark_disagreeing(surface, disagree);
    rows = residue_rows(surface, step.areas, rows.size(), true);
    set_own_differences(rows, own, own_on_target, target_of);
  }
  ResidueCheck check = check_residues(rows, own);
  check.n_disagreeing = n_disagreeing;
  bool applies = check.n_residues >= kLeastComparedResidues;
  constexpr double kSureCorrelation = 0.9;
  if (applies && !(check.correlation >= kSureCorrelation)) {
    const double differences = rms_own_difference(rows),
                 noise = noise_of_residues(states, source, own, target_of, rows);
    constexpr double kNoiseFactor = 2;
    applies = differences > kNoiseFactor * noise;
    if (!applies)
      agreement.warnings.push_back(is_one_state(states, rows, check.rms_potential)
                                       ? one_state_warning()
                                       : noise_warning(differences, noise, unit));
  }
  if (applies) agreement.check = check;
  agreement.is_not_checked = !applies;
  agreement.rows = std::move(rows);
  return agreement;
}

}  // namespace espdiff
