// evaluate.cpp: the stages after the mapping, in order.
#include "compare/evaluate.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "align/compared_chains.h"
#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "align/protonation.h"
#include "certificate/certificate.h"
#include "certificate/residue_rows.h"
#include "certificate/slip.h"
#include "certificate/uncovered_surface.h"
#include "compare/stages/compare_potentials.h"
#include "compare/stages/measured_parts.h"
#include "compare/stages/patches_of_fields.h"
#include "compare/stages/residue_check.h"
#include "engine/engine.h"
#include "input_checks/input_warnings.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// Which chains and which protonation states were compared.
void describe_chains(const Molecule& a, const Molecule& b, const std::vector<std::uint8_t>& region,
                     const std::vector<std::int32_t>& target_of, CompareResult& result) {
  InputReport& inputs = result.inputs;
  inputs.chains = compared_chains(a, b, target_of);
  inputs.source_copies = repeated_chains(a);
  inputs.target_copies = repeated_chains(b);
  if (!a.charges.empty() && !b.charges.empty()) inputs.protonation = protonation_differences(a, b, target_of);
  if (!inputs.protonation.empty()) inputs.warnings.push_back({protonation_warning(inputs.protonation, a), false});
  append(inputs.warnings, composition_warnings(a, b, region, result));
}

/// The verdicts on the whole and on its parts.
void judge_all(const Molecule& molecule, const SurfaceAreas& areas, double required_share,
               std::vector<MeasuredPart>& parts, CompareResult& result) {
  Certificate& certificate = result.certificate;
  certificate.trusted = sum_trusted(result.surface, areas, {}, certificate.unmatched_target);
  certificate.turned = turned_area(result.surface, areas, {}, molecule);
  certificate.untrusted_parts = untrusted_parts(result.surface, areas, result.residues, molecule);
  judge(result, result.inputs.warnings, molecule, required_share);
  for (MeasuredPart& part : parts) finish_part(part, result, areas, molecule, required_share);
}

}  // namespace

void append(std::vector<Warning>& all, std::vector<Warning> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

std::optional<Readings> evaluate(const StatesToMap& states, const std::vector<Field>& fields,
                                 const ComparedSide& source, const ComparedSide& target, PotentialUnit unit,
                                 MappedStep& step, CompareResult& result, const Progress& progress, StageClock& clock) {
  Engine& engine = states.engine;
  const CompareOptions& options = states.options;
  progress.report("metrics", 0.0);
  Certificate& certificate = result.certificate;
  if (!certificate.slip) certificate.not_checked.emplace_back("slip");
  const std::vector<std::int32_t> target_of = paired_residues(states.source, states.target, result.alignment.pairing);
  std::vector<MeasuredPart> parts = measure_parts(states, step, source.input.parts, target_of);
  MappedNormals normals = normals_of(states, step);
  MappedSurface& s = result.surface = std::move(step.surface);
  s.normals = std::move(normals.target);
  s.source_normals = std::move(normals.source);
  const std::vector<float> beyond = engine.download(certificate.target_to_mapped.beyond);
  if (std::any_of(beyond.begin(), beyond.end(), [](float flag) { return flag != 0; }))
    result.uncovered = uncovered_surface(engine.download(target.surface.mesh), beyond, inverse(step.frame.from_target));
  const PotentialSide of_source{source.input, source.map.map, source.surface},
      of_target{target.input, target.map.map, target.surface};
  std::vector<PotentialSamples> samples;
  result.residues = std::move(step.rows);
  if (target.map.map != nullptr) {
    samples = sample_potentials(engine, of_source, of_target, options, step);
    s.potential_source = samples.front().source;
    s.potential_target = samples.front().target;
    set_unmatched_to_nan(step.is_matched, s.potential_target);
    mark_without_potential(s);
    certificate.outside_maps = share_outside(s, matched_areas(s, step.areas));
    result.residues = residue_rows(s, step.areas, states.source.residues.size(), true);
  }
  ResidueAgreement agreement =
      check_residues_of(states, of_source, of_target, unit, step, target_of, s, std::move(result.residues));
  result.residues = std::move(agreement.rows);
  certificate.residues = agreement.check;
  if (agreement.is_not_checked) certificate.not_checked.emplace_back("residues");
  append(result.inputs.warnings, std::move(agreement.warnings));
  if (target.map.map != nullptr) result.potential = compare_potentials(engine, samples, unit, step, s, parts);
  ComparedFields compared = compare_fields(
      engine, fields, {source.fields, states.source, source.surface.atoms, step.frame.from_source, source.map.map},
      {target.fields, states.target, target.surface.atoms, step.frame.from_target, target.map.map}, options, step,
      result, parts);
  result.fields = std::move(compared.fields);
  append(result.inputs.warnings, std::move(compared.warnings));
  FoundPatches found = find_patches_of_fields(options, result);
  result.field_patches = std::move(found.patches);
  append(result.inputs.warnings, std::move(found.warnings));
  describe_chains(states.source, states.target, source.input.parts.region, target_of, result);
  judge_all(states.source, step.areas, options.required_share, parts, result);
  clock.lap("metrics");
  std::optional<Readings> readings;
  if (!options.causes.empty())
    readings = take_readings(engine, of_source, of_target, options, parts, target_of, step, result);
  for (MeasuredPart& part : parts) result.parts.push_back(std::move(part.result));
  return readings;
}

}  // namespace espdiff
