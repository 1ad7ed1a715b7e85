// compare.cpp: the stages of a comparison, in order.
#include "compare/compare.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "align/compared_chains.h"
#include "align/geometry/rigid_domains.h"
#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "align/protonation.h"
#include "base/error.h"
#include "base/handles.h"
#include "certificate/certificate.h"
#include "certificate/residue_rows.h"
#include "certificate/result.h"
#include "certificate/round_trip.h"
#include "certificate/slip.h"
#include "certificate/uncovered_surface.h"
#include "certificate/untrusted_parts.h"
#include "compare/choose_motions.h"
#include "compare/series.h"
#include "compare/stages/fields.h"
#include "compare/stages/last_step.h"
#include "compare/stages/mapped_step.h"
#include "compare/stages/measured_parts.h"
#include "compare/stages/potentials.h"
#include "compare/stages/readings.h"
#include "engine/engine.h"
#include "field/field_kinds.h"
#include "input_checks/composition_warnings.h"
#include "input_checks/input_warnings.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"
#include "mapping/side_maps.h"
#include "motions/common_frame.h"
#include "motions/local_motions.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// Adds warnings behind those of earlier stages.
void append(std::vector<Warning>& all, std::vector<Warning> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// Which chains and which protonation states were compared.
void describe_chains(const Molecule& a, const Molecule& b, const std::vector<std::uint8_t>& region,
                     const std::vector<std::int32_t>& target_of, CompareResult& result) {
  InputReport& inputs = result.inputs;
  inputs.chains = compared_chains(a, b, target_of);
  inputs.source_copies = repeated_chains(a);
  inputs.target_copies = repeated_chains(b);
  if (!a.charges.empty() && !b.charges.empty()) inputs.protonation = protonation_differences(a, b, target_of);
  if (!inputs.protonation.empty()) inputs.warnings.push_back({protonation_warning(inputs.protonation, a), false});
  append(inputs.warnings, composition_warnings(a, b, region, result.alignment, result.surface, result.uncovered));
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

/// The stages of a step, and the state kept between steps; all in the common frame, which is the source's.
struct Series::Steps {
  Engine& engine;
  ComparedSide source;  ///< its map is made by the first step
  CompareOptions options;
  std::vector<Field> fields{};  ///< besides the potential
  bool prepared = false;
  RegularizedSurface regularized{};
  PotentialUnit unit = PotentialUnit::kUnknown;              ///< of the source's map
  std::shared_ptr<const MapReferences> source_references{};  ///< for the source's given map
  std::optional<LastStep> last{};                            ///< empty if the next step starts from the source
  std::optional<SeriesState> restored{};

  void prepare(const RigidTransform& to_common, const Progress& progress, StageClock& clock) {
    if (prepared) return;
    source.surface = build_surface(engine, *source.input.molecule, to_common, options.surface, progress, clock);
    regularized = regularized_for(engine, source.surface, options, progress);
    clock.lap("regularize");
    prepared = true;
    adopt_restored_state();
  }

  void adopt_restored_state() {
    if (!restored) return;
    last = last_step_of(engine, *restored, regularized.mesh, options.method);
    restored.reset();
  }

  /// How far outside the surfaces potentials are read, or side chains may have other places.
  double potential_reach() const {
    constexpr double kSideChain_A = 7;  // from CB to the last hydrogen of arginine
    const double read_A = *std::max_element(options.offsets_A.begin(), options.offsets_A.end());
    return options.side_chains > 0 ? std::max(read_A, kSideChain_A) : read_A;
  }

  /// The target's map; the source's too, unless it is there already.
  void make_maps(ComparedSide& target, const CommonFrame& frame, ComparedMaps& maps, const Progress& progress) {
    if (!has_map(target.input)) return;
    const PotentialUnit wanted = common_unit(source.input, target.input);
    const double temperature_K = options.temperature_K;
    const bool for_readings = !options.causes.empty();
    const double reach_A = potential_reach();
    if (source.map.map == nullptr || wanted != unit) {
      source.map = device_map(engine, source.input, inverse(frame.from_source), {nullptr, for_readings, reach_A},
                              wanted, temperature_K, progress);
      unit = wanted;
    }
    if (source.input.make_map) maps.source_recipe = std::make_shared<const MapRecipe>(source.map.recipe);
    refuse_nonlinear(options, source.map.recipe);
    // An iteration may start from the source's potential, whatever steps were made before: the bits of a step do not
    // depend on them.
    const GridPtr before = source.input.make_map ? source.map.map : nullptr;
    target.map = device_map(engine, target.input, inverse(frame.from_target), {before, for_readings, reach_A}, wanted,
                            temperature_K, progress);
    if (target.input.make_map) maps.target_recipe = std::make_shared<const MapRecipe>(std::move(target.map.recipe));
  }

  /// The states of a step, whose surfaces are there.
  StatesToMap states(const ComparedSide& target, const Alignment& alignment) const {
    return {engine,
            options,
            *source.input.molecule,
            source.surface,
            regularized.mesh,
            options.method == Method::kMorph,
            *target.input.molecule,
            target.surface,
            alignment};
  }

  /// Whether a mapping that slips is tried again. Inputs that cannot be right, such as mirror images, are refused
  /// whatever the mapping, and their local motions are wild and slow to follow.
  /// @param warnings about the molecules; those about maps play no part
  bool may_map_again(const std::vector<Warning>& warnings) const {
    return options.domains == kLocalAsNeeded && options.method == Method::kMorph &&
           std::none_of(warnings.begin(), warnings.end(), [](const Warning& w) { return w.refuses; });
  }

  /// Maps once, or twice where the first mapping slips. A step that continues from the one before is mapped once: its
  /// way is composed of small steps. Where atoms go far, so that it slips most likely, the first mapping takes long
  /// steps, and is made again in usual ones if it is to be kept, or if the steps may decide about that.
  /// @param before the step to continue from; null for the source
  /// @param again  from may_map_again()
  MappedStep map_as_needed(const StatesToMap& states, const CommonFrame& frame, const LastStep* before, bool again,
                           const Progress& progress, StageClock& clock) const {
    const KeptTurns kept = options.leave_out_turned ? KeptTurns::kNone : KeptTurns::kNear;
    const auto map_straight = [&](double step_factor) {
      return map_once(states, frame, {before, "morph", step_factor}, kept, progress, clock);
    };
    again = again && before == nullptr;
    bool is_trial = again && will_slip(states, frame);
    MappedStep straight = map_straight(is_trial ? kTrialSteps : 1);
    if (is_trial && !slips_clearly(straight, states)) {
      straight = map_straight(1);
      is_trial = false;
    }
    if (!again || !slips(straight, states)) return straight;
    CommonFrame local = frame;
    local.follows = kLocalMotions;
    local.followed =
        local_motions(states.source, states.target, states.alignment.pairing, frame.from_source, frame.from_target);
    try {
      MappedStep second = map_once(states, local, {nullptr, "second morph"}, kept, progress, clock);
      if (is_trial && !keeps_local_clearly(straight, second, states)) straight = map_straight(1);
      return better_of(std::move(straight), std::move(second), states);
    } catch (const GeometryError& error) {  // no surface remains
      return without_second(is_trial ? map_straight(1) : std::move(straight), error.message());
    }
  }

  /// Frees the surfaces and the potentials, which the causes of the series' last step do not need.
  void release(ComparedSide& target, MappedStep& step) {
    source.surface = target.surface = {};
    regularized.mesh.reset();
    source.map.map.reset();
    target.map.map.reset();
    source_references.reset();
    last.reset();
    step.morphed = {};
    step.mapping = {};
    step.moved.reset();
  }

  /// Refuses what cannot be compared, before any work.
  void check_inputs(const CompareInput& target) const {
    check_maps(source.input, target);
    if (!options.causes.empty()) check_causes(options, source.input, target);
    if (has_map(source.input)) return;
    refuse_fields_of_potential(fields);
    refuse_patches_of_potential(options);
  }

  /// Takes over what a mapping reports, and checks it by mapping back where that is asked for.
  /// @param not_checked names of the checks of the inputs that were not made
  void adopt_mapping(const StatesToMap& states, MappedStep& step, std::vector<std::string> not_checked,
                     CompareResult& result, const Progress& progress, StageClock& clock) const {
    const StartFrom start = result.mapping.start;
    result.mapping = step.report;
    result.mapping.start = start;
    result.mapping.regularize = regularized.report;
    result.n_steps = step.report.morph.steps > 0 ? step.report.morph.steps : step.report.deform.iterations;
    result.area_mapped_A2 = step.mapping.fit.area_A2;
    result.certificate = step.certificate;
    result.certificate.not_checked = std::move(not_checked);
    if (options.round_trip) {
      const Mapping back = map_back(states, step.frame, progress);
      result.certificate.round_trip = measure_round_trip(engine, step.mapping, back);
      clock.lap("round trip");
    } else {
      result.certificate.not_checked.emplace_back("round_trip");
    }
  }

  /// The numbers of a mapping, stage by stage, and the verdicts on the whole and its parts.
  /// @param step   its surface and rows become the result's
  /// @param result with what the stages before found; receives the rest, but for the causes
  /// @returns the readings whose causes are asked for
  std::optional<Readings> evaluate(const StatesToMap& states, const ComparedSide& target, MappedStep& step,
                                   CompareResult& result, const Progress& progress, StageClock& clock) const {
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
      result.uncovered =
          uncovered_surface(engine.download(target.surface.mesh), beyond, inverse(step.frame.from_target));
    std::vector<PotentialSamples> samples;
    result.residues = std::move(step.rows);
    if (target.map.map != nullptr) {
      samples = sample_potentials(engine, source, target, options, step);
      s.potential_source = samples.front().source;
      s.potential_target = samples.front().target;
      set_unmatched_to_nan(step.is_matched, s.potential_target);
      mark_without_potential(s);
      certificate.outside_maps = share_outside(s, matched_areas(s, step.areas));
      result.residues = residue_rows(s, step.areas, states.source.residues.size(), true);
    }
    ResidueAgreement agreement =
        check_residues_of(states, source, target, unit, step, target_of, s, std::move(result.residues));
    result.residues = std::move(agreement.rows);
    certificate.residues = agreement.check;
    if (agreement.is_not_checked) certificate.not_checked.emplace_back("residues");
    append(result.inputs.warnings, std::move(agreement.warnings));
    if (target.map.map != nullptr) result.potential = compare_potentials(engine, samples, unit, step, s, parts);
    if (!fields.empty() || !options.patches_of.empty()) {
      ComparedFields compared =
          compare_fields(engine, fields, source, target, options, step, s, result.potential.unit, parts);
      result.fields = std::move(compared.fields);
      result.field_patches = std::move(compared.patches);
      append(result.inputs.warnings, std::move(compared.warnings));
    }
    describe_chains(states.source, states.target, source.input.parts.region, target_of, result);
    judge_all(states.source, step.areas, options.required_share, parts, result);
    clock.lap("metrics");
    std::optional<Readings> readings;
    if (!options.causes.empty())
      readings = take_readings(engine, source, target, options, parts, target_of, step, result);
    for (MeasuredPart& part : parts) result.parts.push_back(std::move(part.result));
    return readings;
  }

  /// Runs the stages in order; see Series::step().
  /// @param is_last of the series
  CompareResult step(const CompareInput& input, StartFrom start, bool is_last, const Progress& progress) {
    CompareResult result;
    StageClock clock(result.time_ms);
    check_inputs(input);
    ComparedSide target{input, make_state_fields(fields, *input.molecule, {FieldSide::kTarget, input.fields})};
    progress.report("align", 0.0);
    const AlignedStates aligned = align(*source.input.molecule, *input.molecule, options);
    const CommonFrame& frame = aligned.frame;
    result.alignment = aligned.alignment;
    result.rmsd_A = aligned.alignment.rmsd_A;
    result.inputs.warnings = input_warnings(*source.input.molecule, *input.molecule, aligned.alignment);
    const bool again = may_map_again(result.inputs.warnings);
    clock.lap("align");
    make_maps(target, frame, result.maps, progress);
    if (target.map.map != nullptr) clock.lap("potential");

    prepare(frame.from_source, progress, clock);
    target.surface = build_surface(engine, *input.molecule, frame.from_target, options.surface, progress, clock);
    result.source_surface = source.surface.summary;
    result.target_surface = target.surface.summary;
    const StatesToMap states = this->states(target, aligned.alignment);
    PotentialFindings findings =
        check_potentials(states, frame, source.input, input, source_references, result.maps, progress);
    append(result.inputs.warnings, std::move(findings.warnings));
    clock.lap("check of maps");

    std::vector<Vec3d> target_atoms =
        counterparts(*source.input.molecule, *input.molecule, aligned.alignment.pairing, frame.from_target);
    const std::optional<LastStep> from = std::exchange(last, std::nullopt);
    if (start == StartFrom::kPrevious && from && can_continue(*from, *source.input.molecule, frame, target_atoms))
      result.mapping.start = StartFrom::kPrevious;
    const LastStep* const before = result.mapping.start == StartFrom::kPrevious ? &*from : nullptr;
    MappedStep mapped = map_as_needed(states, frame, before, again, progress, clock);
    adopt_mapping(states, mapped, std::move(findings.not_checked), result, progress, clock);
    std::optional<Readings> readings = evaluate(states, target, mapped, result, progress, clock);
    if (options.method == Method::kMorph) {
      last = after_morph(mapped.morphed, *input.molecule, frame.from_target, std::move(target_atoms), before,
                         result.certificate.unmatched_source);
    } else if (mapped.report.deform.converged) {
      last = after_deform(engine, regularized.mesh, mapped.mapping.mapped, std::move(target_atoms));
    }
    if (is_last) release(target, mapped);
    if (readings) {
      FoundCauses found =
          find_causes(engine, *std::move(readings), {*source.input.molecule, *source.map.charges, frame.from_source},
                      {*input.molecule, *target.map.charges, frame.from_target}, options, result, progress);
      result.causes = std::move(found.causes);
      append(result.inputs.warnings, std::move(found.warnings));
      clock.lap("causes");
    }
    clock.finish();
    progress.report("metrics", 1.0);
    return result;
  }
};

Series::Series(Engine& engine, const CompareInput& source, const CompareOptions& options)
    : steps_(new Steps{engine, {source}, options}) {
  steps_->fields = make_fields(options.fields);
  steps_->source.fields = make_state_fields(steps_->fields, *source.molecule, {FieldSide::kSource, source.fields});
}
Series::~Series() = default;

CompareResult Series::step(const CompareInput& target, StartFrom start, const Progress& progress) {
  try {
    return steps_->step(target, start, false, progress);
  } catch (...) {
    steps_->last.reset();
    steps_->restored.reset();
    throw;
  }
}

CompareResult Series::finish(const CompareInput& target, const Progress& progress) {
  return steps_->step(target, StartFrom::kSource, true, progress);
}

std::optional<SeriesState> Series::state() const {
  const Steps& steps = *steps_;
  if (steps.restored) return steps.restored;
  if (!steps.last) return std::nullopt;
  return state_of(steps.engine, *steps.last);
}

void Series::restore(SeriesState state) {
  Steps& steps = *steps_;
  if (state.target.size() != steps.source.input.molecule->size())
    throw InputError("the saved state is of a source with " + std::to_string(state.target.size()) +
                     " atoms, this one has " + std::to_string(steps.source.input.molecule->size()) +
                     "; start the series anew");
  steps.restored = std::move(state);
  if (steps.prepared) steps.adopt_restored_state();
}

CompareResult compare(Engine& engine, const CompareInput& source, const CompareInput& target,
                      const CompareOptions& options, const Progress& progress) {
  return Series(engine, source, options).finish(target, progress);
}

}  // namespace espdiff
