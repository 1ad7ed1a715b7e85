// compare.cpp: the stages of a comparison, in order.

#include <algorithm>
#include <limits>
#include <utility>

#include "align/compared_chains.h"
#include "align/geometry/rigid_domains.h"
#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "align/protonation.h"
#include "base/error.h"
#include "base/handles.h"
#include "base/text/short_numbers.h"
#include "certificate/certificate.h"
#include "certificate/own_potentials.h"
#include "certificate/residue_rows.h"
#include "certificate/result.h"
#include "certificate/round_trip.h"
#include "certificate/slip.h"
#include "compare/choose_motions.h"
#include "compare/compare.h"
#include "compare/compare_fields.h"
#include "compare/compare_potentials.h"
#include "compare/last_step.h"
#include "compare/mapped_step.h"
#include "compare/measured_parts.h"
#include "compare/readings.h"
#include "compare/series.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"
#include "field/field_kinds.h"
#include "input_checks/input_warnings.h"
#include "input_checks/map_check.h"
#include "input_checks/map_warnings.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_by_deform.h"
#include "mapping/map_by_morph.h"
#include "mapping/map_recipe.h"
#include "mapping/mapping.h"
#include "mapping/sample_outside.h"
#include "mapping/side_maps.h"
#include "motions/atom_paths.h"
#include "motions/common_frame.h"
#include "motions/domain_motions.h"
#include "motions/local_motions.h"
#include "options/options.h"

namespace espdiff {

/// The stages of a step, and the state kept between steps; all in the common frame, which is the source's.
struct Series::Steps {
  Engine& engine;
  CompareInput source;
  CompareOptions options;
  std::vector<Field> fields{};  ///< besides the potential
  StateFields source_fields{};  ///< of the source, one for each of them
  bool prepared = false;
  Surface surface{};
  MeshPtr regularized{};
  DeformReport regularize_report{};
  PotentialUnit unit = PotentialUnit::kUnknown;              ///< of the source's map
  MadeMap source_map{};                                      ///< made by the first step
  std::shared_ptr<const Molecule> target_charges{};          ///< of the step's computed map
  std::shared_ptr<const MapReferences> source_references{};  ///< for the source's given map
  std::optional<LastStep> last{};                            ///< empty if the next step starts from the source
  std::optional<SeriesState> restored{};

  void prepare(const RigidTransform& to_common, const Progress& progress, StageClock& clock) {
    if (prepared) return;
    surface = build_surface(engine, *source.molecule, to_common, options.surface, progress, clock);
    // The morph keeps closed cavities, since one may open.
    const MeshPtr& mesh = options.method == Method::kMorph ? surface.whole : surface.mesh;
    regularized = regularize(engine, surface, mesh, options, progress, &regularize_report);
    clock.lap("regularize");
    prepared = true;
    adopt_restored_state();
  }

  void adopt_restored_state() {
    if (!restored) return;
    last = last_step_of(engine, *restored, regularized, options.method);
    restored.reset();
  }

  /// The mapping from the target's surface to the source's, in the same common frame.
  Mapping map_back(const CompareInput& target, const Surface& target_surface, const CommonFrame& frame,
                   const AtomPairing& pairing, const Progress& progress) const {
    std::vector<std::pair<std::string, double>> times;  // the caller's clock has one entry for the whole mapping
    StageClock clock(times);
    Steps back{engine, target, options, {}, {}, true, target_surface};
    const MeshPtr& mesh = options.method == Method::kMorph ? target_surface.whole : target_surface.mesh;
    back.regularized = espdiff::regularize(engine, target_surface, mesh, options, progress, &back.regularize_report);
    CompareResult scratch;
    for (const auto& [s, t] : pairing.pairs) scratch.pairing.pairs.emplace_back(t, s);
    const auto source_of = paired_residues(*target.molecule, *source.molecule, scratch.pairing);
    const CommonFrame reversed{frame.from_target, frame.from_source, inverse(frame.domains, source_of),
                               inverse(frame.followed, source_of)};
    Mapping mapping;
    if (options.method == Method::kMorph) {
      const auto paths = back.paths_to(*source.molecule, reversed, scratch.pairing, progress);
      mapping = mapping_of(
          engine, back.morph(*source.molecule, surface, reversed, paths, nullptr, scratch, "morph", progress, clock));
    } else {
      mapping = back.deform(surface, reversed.domains.carry(engine, back.regularized, target_surface.atoms), reversed,
                            scratch, progress, clock);
    }
    back.find_matched(mapping, surface);
    return mapping;
  }

  /// The paths of all atoms from the source to a target; see atom_paths().
  std::vector<MovingAtom> paths_to(const Molecule& target, const CommonFrame& frame, const AtomPairing& pairing,
                                   const Progress& progress) const {
    return atom_paths(*source.molecule, target, pairing, frame.from_source, frame.from_target, frame.followed,
                      options.surface.radius_scale, progress);
  }

  /// @param paths of paths_to()
  /// @param from the step to continue from; null for the source
  /// @param stage name for progress reports  @param step_factor of the largest step
  MorphResult morph(const Molecule& target, const Surface& target_surface, const CommonFrame& frame,
                    const std::vector<MovingAtom>& paths, const LastStep* from, CompareResult& result,
                    const std::string& stage, const Progress& progress, StageClock& clock,
                    double step_factor = 1) const {
    MorphOptions morph = morph_options(options);
    morph.max_step_A *= step_factor;
    MorphResult morphed;
    if (from != nullptr) {
      const auto step_paths =
          paths_from(*from, *source.molecule, target, frame.from_target, result.domains, options, progress);
      morphed = engine.continue_morph(*from->morphed, step_paths, surface.atoms, target_surface.atoms, morph, stage,
                                      progress);
    } else {
      morphed = engine.morph(regularized, paths, surface.atoms, target_surface.atoms, morph, stage, progress);
    }
    result.morph_report = morphed.report;
    result.morph_report.n_vertices_added = engine.n_vertices(morphed.source) - engine.n_vertices(regularized);
    clock.lap("morph");
    return morphed;
  }

  Mapping deform(const Surface& target, const MeshPtr& start, const CommonFrame& frame, CompareResult& result,
                 const Progress& progress, StageClock& clock) {
    const FieldPtr field = make_field(engine, surface, target, options, progress, &result.flow_report);
    clock.lap("field");
    Mapping mapping = map_by_deform(engine, surface, regularized, target, start, frame.domains, field, options,
                                    progress, result.deform_report, result.n_vertices_subdivided);
    clock.lap("deform");
    return mapping;
  }

  /// How far outside the surfaces potentials are read, or side chains may have other places.
  double potential_reach_A() const {
    constexpr double kSideChain_A = 7;  // from CB to the last hydrogen of arginine
    const double read_A = *std::max_element(options.offsets_A.begin(), options.offsets_A.end());
    return options.side_chains > 0 ? std::max(read_A, kSideChain_A) : read_A;
  }

  /// The target's map, null where there is none; the source's too, unless it is there already.
  GridPtr make_maps(const CompareInput& target, const CommonFrame& frame, CompareResult& result,
                    const Progress& progress) {
    if (!has_map(target)) return nullptr;
    const PotentialUnit wanted = common_unit(source, target);
    const double temperature_K = options.temperature_K;
    const bool for_readings = !options.causes.empty();
    const double reach_A = potential_reach_A();
    if (source_map.map == nullptr || wanted != unit) {
      source_map = device_map(engine, source, inverse(frame.from_source), {nullptr, for_readings, reach_A}, wanted,
                              temperature_K, progress);
      unit = wanted;
    }
    if (source.make_map) result.source_recipe = std::make_shared<const MapRecipe>(source_map.recipe);
    refuse_nonlinear(options, source_map.recipe);
    // An iteration may start from the source's potential, whatever steps were made before: the bits of a step do not
    // depend on them.
    const GridPtr before = source.make_map ? source_map.map : nullptr;
    MadeMap made = device_map(engine, target, inverse(frame.from_target), {before, for_readings, reach_A}, wanted,
                              temperature_K, progress);
    if (target.make_map) result.target_recipe = std::make_shared<const MapRecipe>(std::move(made.recipe));
    target_charges = std::move(made.charges);
    return made.map;
  }

  /// Finds the part of the mapping that is matched on the target's surface; drops unmatched closed cavities.
  void find_matched(Mapping& mapping, const Surface& target_surface) const {
    find_matched_part(engine, mapping, target_surface.atoms, target_surface.mesh,
                      static_cast<float>(options.surface.isovalue));
    if (options.method == Method::kMorph && !options.surface.cavities) drop_closed_cavities(engine, mapping);
  }

  /// Finds the matched part and certifies it.
  void check(Mapping& mapping, const Surface& target_surface, CompareResult& result, const Progress& progress) const {
    progress.report("certificate", 0.0);
    find_matched(mapping, target_surface);
    result.area_mapped_A2 = mapping.fit.area_A2;
    std::vector<std::string> not_checked = std::move(result.certificate.not_checked);
    result.certificate = certify(engine, mapping, target_surface.mesh);
    result.certificate.not_checked = std::move(not_checked);
    result.certificate.converged = options.method == Method::kMorph || result.deform_report.converged;
  }

  /// [residue] a molecule's potentials on its own surface, at the first of the offsets.
  std::vector<OwnPotential> own_on(const Surface& side, const GridPtr& map,
                                   const std::vector<std::int32_t>& partner_of) const {
    OutsideSamples samples = sample_outside(engine, map, side.mesh, side.atoms,
                                            static_cast<float>(options.surface.isovalue), options.offsets_A.front());
    for (std::size_t v = 0; v < samples.values.size(); ++v) {
      if (samples.inside[v] != 0) samples.values[v] = std::numeric_limits<float>::quiet_NaN();
    }
    return own_potentials(engine.download_shape(side.mesh), engine.vertex_residues(side.mesh, side.atoms),
                          samples.values, partner_of);
  }

  /// How much the residues' potentials differ between two meshes of one surface, the source's: what the grids alone
  /// make of no difference at all.
  double noise_of_residues(const std::vector<OwnPotential>& own, const std::vector<std::int32_t>& target_of,
                           std::vector<ResidueRow> rows) const {
    std::vector<std::int32_t> itself(target_of.size());
    for (std::size_t r = 0; r < itself.size(); ++r) itself[r] = target_of[r] < 0 ? -1 : static_cast<std::int32_t>(r);
    set_own_differences(rows, own, own_on(surface, source_map.map, target_of), itself);
    return rms_own_difference(rows);
  }

  /// Each residue's difference from its potentials on its own surfaces, and how the mapped differences agree.
  void check_against_own(const CompareInput& target, const GridPtr& target_map, const Mapping& mapping,
                         const Surface& target_surface, const std::vector<std::int32_t>& target_of,
                         const SurfaceAreas& areas, CompareResult& result) const {
    if (target_map == nullptr || result.pairing.pairs.empty()) {
      for (ResidueRow& row : result.residues)
        row.own_difference = row.own_area_A2 = std::numeric_limits<double>::quiet_NaN();
      if (target_map != nullptr) result.certificate.not_checked.emplace_back("residues");
      return;
    }
    const MappedSurface& s = result.surface;
    const std::vector<OwnPotential> own =
        own_potentials(engine.download_shape(mapping.source), s.residue, s.potential_source, target_of);
    const std::vector<std::int32_t> source_of = source_residues(target_of, target.molecule->residues.size());
    const std::vector<OwnPotential> own_on_target = own_on(target_surface, target_map, source_of);
    set_own_differences(result.residues, own, own_on_target, target_of);
    const std::vector<std::uint8_t> disagree = disagreeing_residues(result.residues, own);
    const auto n_disagreeing = static_cast<std::size_t>(std::count(disagree.begin(), disagree.end(), 1));
    if (n_disagreeing > 0) {
      mark_disagreeing(result.surface, disagree);
      result.residues = residue_rows(s, areas, result.residues.size(), true);
      set_own_differences(result.residues, own, own_on_target, target_of);
    }
    ResidueCheck check = check_residues(result.residues, own);
    check.n_disagreeing = n_disagreeing;
    bool applies = check.n_residues >= kLeastComparedResidues;
    constexpr double kSureCorrelation = 0.9;
    if (applies && !(check.correlation >= kSureCorrelation)) {
      const double differences = rms_own_difference(result.residues),
                   noise = noise_of_residues(own, target_of, result.residues);
      constexpr double kNoiseFactor = 2;
      applies = differences > kNoiseFactor * noise;
      if (!applies)
        result.warnings.push_back({"the residues' potentials differ by " + short_number(differences) + " " +
                                       to_string(unit) + " (rms) between the states, and by " + short_number(noise) +
                                       " between two meshes of the source's surface: their correlation is one of noise "
                                       "with noise and was not judged",
                                   false});
    }
    if (applies)
      result.certificate.residues = check;
    else
      result.certificate.not_checked.emplace_back("residues");
  }

  /// Fills in the results of a mapping: normals, potentials, metrics, residues, and the verdict.
  /// @returns the readings whose causes are asked for
  std::optional<Readings> evaluate(const CompareInput& target, const StateFields& target_fields,
                                   const Surface& target_surface, const GridPtr& target_map, MappedStep& step,
                                   const Progress& progress, StageClock& clock) {
    progress.report("metrics", 0.0);
    CompareResult& result = step.result;
    const float isovalue = static_cast<float>(options.surface.isovalue);
    add_normals(engine, surface, target_surface, isovalue, step);
    if (!result.certificate.slip) result.certificate.not_checked.emplace_back("slip");
    const std::vector<std::int32_t> target_of = paired_residues(*source.molecule, *target.molecule, result.pairing);
    const std::vector<MeasuredPart> parts =
        measure_parts(engine, source, target, target_surface, isovalue, target_of, step);
    const std::vector<float> beyond = engine.download(result.certificate.target_to_mapped.beyond);
    if (std::any_of(beyond.begin(), beyond.end(), [](float flag) { return flag != 0; }))
      result.uncovered =
          uncovered_surface(engine.download(target_surface.mesh), beyond, inverse(step.frame.from_target));
    std::vector<PotentialSamples> samples;
    if (target_map != nullptr) {
      samples = sample_potentials(engine, {source, source_map.map, surface.atoms},
                                  {target, target_map, target_surface.atoms}, options, unit, step);
      mark_without_potential(result.surface);
      result.certificate.outside_maps = share_outside(result.surface, matched_areas(result.surface, step.areas));
      result.residues = residue_rows(result.surface, step.areas, source.molecule->residues.size(), true);
    }
    check_against_own(target, target_map, step.mapping, target_surface, target_of, step.areas, result);
    if (target_map != nullptr) compare_potentials(engine, samples, parts, step);
    compare_fields(engine, fields,
                   {source_fields, *source.molecule, surface.atoms, step.frame.from_source, source_map.map},
                   {target_fields, *target.molecule, target_surface.atoms, step.frame.from_target, target_map}, options,
                   parts, step);
    find_patches_of_fields(options, result);
    describe_chains(target, target_of, result);
    Certificate& certificate = result.certificate;
    certificate.trusted = sum_trusted(result.surface, step.areas, {}, certificate.unmatched_target);
    certificate.turned = turned_area(result.surface, step.areas, {}, *source.molecule);
    certificate.untrusted_parts = untrusted_parts(result.surface, step.areas, result.residues, *source.molecule);
    judge(result, *source.molecule, options.required_share);
    for (const MeasuredPart& part : parts)
      finish_part(part, result, step.areas, *source.molecule, options.required_share);
    clock.lap("metrics");
    if (options.causes.empty()) return std::nullopt;
    return take_readings(engine, {source, source_map.map, surface.atoms}, {target, target_map, target_surface.atoms},
                         options, parts, target_of, step);
  }

  /// Frees the surfaces and the potentials, which the causes of the series' last step do not need.
  void release(Surface& target_surface, GridPtr& target_map, MappedStep& step) {
    surface = target_surface = {};
    regularized.reset();
    source_map.map.reset();
    target_map.reset();
    source_references.reset();
    last.reset();
    step.morphed = {};
    step.mapping = {};
    step.moved.reset();
  }

  /// Which chains and which protonation states were compared.
  void describe_chains(const CompareInput& target, const std::vector<std::int32_t>& target_of,
                       CompareResult& result) const {
    const Molecule &a = *source.molecule, &b = *target.molecule;
    result.chains = compared_chains(a, b, target_of);
    result.source_copies = repeated_chains(a);
    result.target_copies = repeated_chains(b);
    if (!a.charges.empty() && !b.charges.empty()) result.protonation = protonation_differences(a, b, target_of);
    if (!result.protonation.empty()) result.warnings.push_back({protonation_warning(result.protonation, a), false});
    for (Warning& warning : composition_warnings(a, b, source.parts.region, result))
      result.warnings.push_back(std::move(warning));
  }

  /// Given maps against the molecules, and the two potentials against each other.
  void check_potentials(const CompareInput& target, const Surface& target_surface, const CommonFrame& frame,
                        CompareResult& result, const Progress& progress) {
    const auto references = [&](const CompareInput& side, const Surface& of_side, const RigidTransform& to_common) {
      return std::make_shared<const MapReferences>(engine, *side.molecule, to_common, of_side,
                                                   static_cast<float>(options.surface.isovalue), options.temperature_K,
                                                   progress);
    };
    std::vector<Warning> warnings;
    std::shared_ptr<const MapReferences> of_target;
    const auto check = [&](const char* role, const CompareInput& side, const MapReferences& of_side,
                           std::shared_ptr<const MapCheck>& outcome) {
      for (Warning& warning : map_warnings(role, *side.map, of_side, options.temperature_K, outcome))
        warnings.push_back(std::move(warning));
      if (!outcome) result.certificate.not_checked.emplace_back(std::string("map_of_") + role);
    };
    if (source.map != nullptr) {
      if (!source_references) source_references = references(source, surface, frame.from_source);
      check("source", source, *source_references, result.source_map_check);
    }
    if (target.map != nullptr) {
      of_target = references(target, target_surface, frame.from_target);
      check("target", target, *of_target, result.target_map_check);
    }
    pair_warnings(source, target, source_references.get(), of_target.get(), result, warnings);
    if (!options.trust_maps) refuse_vacuum_against_solvent(result);
    for (Warning& warning : kind_warnings(result)) warnings.push_back(std::move(warning));
    for (Warning& warning : warnings) {
      warning.refuses = warning.refuses && !options.trust_maps;
      result.warnings.push_back(std::move(warning));
    }
    for (Warning& warning : water_warnings(result)) result.warnings.push_back(std::move(warning));
  }

  /// Maps the source onto the target once, and certifies the mapping.
  /// @param result of the stages before
  /// @param before the step to continue from; null for the source
  /// @param step_factor of the morph's largest step
  MappedStep map(const CompareInput& target, const Surface& target_surface, const CommonFrame& frame,
                 CompareResult result, const LastStep* before, const std::string& stage, const Progress& progress,
                 StageClock& clock, double step_factor = 1) {
    MappedStep step{frame, {}, {}, {}, {}, {}, {}, std::move(result)};
    // deform needs no pairs; the morph says what it misses.
    if (options.method == Method::kMorph || !step.result.pairing.pairs.empty())
      step.paths = paths_to(*target.molecule, frame, step.result.pairing, progress);
    clock.lap("atom paths");
    if (options.method == Method::kMorph) {
      step.morphed = morph(*target.molecule, target_surface, frame, step.paths, before, step.result, stage, progress,
                           clock, step_factor);
      step.mapping = mapping_of(engine, step.morphed);
    } else {
      const MeshPtr begin =
          before != nullptr ? before->mapped : frame.domains.carry(engine, regularized, surface.atoms);
      step.mapping = deform(target_surface, begin, frame, step.result, progress, clock);
    }
    check(step.mapping, target_surface, step.result, progress);
    describe(engine, *source.molecule, *target.molecule, surface, target_surface,
             options.leave_out_turned ? KeptTurns::kNone : KeptTurns::kNear, step);
    clock.lap("certificate");
    return step;
  }

  /// Whether a mapping that slips is tried again. Inputs that cannot be right, such as mirror images, are refused
  /// whatever the mapping, and their local motions are wild and slow to follow.
  /// @param result with the warnings about the molecules; those about maps, which play no part, come later
  bool may_map_again(const CompareResult& result) const {
    return options.domains == kLocalAsNeeded && options.method == Method::kMorph &&
           std::none_of(result.warnings.begin(), result.warnings.end(), [](const Warning& w) { return w.refuses; });
  }

  /// Maps once, or twice where the first mapping slips. A step that continues from the one before is mapped once: its
  /// way is composed of small steps. Where atoms go far, so that it slips most likely, the first mapping takes long
  /// steps, and is made again in usual ones if it is to be kept.
  /// @param again from may_map_again()
  MappedStep map_as_needed(const CompareInput& target, const Surface& target_surface, const CommonFrame& frame,
                           const CompareResult& result, const LastStep* before, bool again, const Progress& progress,
                           StageClock& clock) {
    const auto map_straight = [&](double step_factor) {
      return map(target, target_surface, frame, result, before, "morph", progress, clock, step_factor);
    };
    again = again && before == nullptr;
    const bool is_trial = again && will_slip(*source.molecule, *target.molecule, result.pairing, frame);
    MappedStep straight = map_straight(is_trial ? kTrialSteps : 1);
    if (!again || !slips(straight.result, *source.molecule)) return is_trial ? map_straight(1) : std::move(straight);
    CommonFrame local = frame;
    local.followed =
        local_motions(*source.molecule, *target.molecule, result.pairing, frame.from_source, frame.from_target);
    CompareResult anew = result;
    anew.domains_used = kLocalMotions;
    try {
      MappedStep second = map(target, target_surface, local, std::move(anew), nullptr, "second morph", progress, clock);
      if (is_trial && !keeps_local(straight, second, *source.molecule)) straight = map_straight(1);
      return better_of(std::move(straight), std::move(second), *source.molecule);
    } catch (const GeometryError& error) {  // no surface remains
      return without_second(is_trial ? map_straight(1) : std::move(straight), error.message());
    }
  }

  /// Runs the stages in order; see Series::step().
  /// @param is_last of the series
  CompareResult step(const CompareInput& target, StartFrom start, bool is_last, const Progress& progress) {
    CompareResult result;
    std::vector<std::pair<std::string, double>> time_ms;
    StageClock clock(time_ms);
    check_maps(source, target);  // before any work
    check_causes(options, source, target);
    if (!has_map(source)) {
      refuse_fields_of_potential(fields);
      refuse_patches_of_potential(options);
    }
    const StateFields target_fields = make_state_fields(fields, *target.molecule, {FieldSide::kTarget, target.fields});
    progress.report("align", 0.0);
    const CommonFrame frame = align(*source.molecule, *target.molecule, options, result);
    result.warnings = input_warnings(*source.molecule, *target.molecule, result);
    const bool again = may_map_again(result);
    clock.lap("align");
    GridPtr target_map = make_maps(target, frame, result, progress);
    if (target_map != nullptr) clock.lap("potential");

    prepare(frame.from_source, progress, clock);
    Surface target_surface =
        build_surface(engine, *target.molecule, frame.from_target, options.surface, progress, clock);
    result.source_surface = surface.summary;
    result.target_surface = target_surface.summary;
    result.regularize_report = regularize_report;
    check_potentials(target, target_surface, frame, result, progress);
    clock.lap("check of maps");

    std::vector<Vec3d> target_atoms =
        counterparts(*source.molecule, *target.molecule, result.pairing, frame.from_target);
    const std::optional<LastStep> from = std::exchange(last, std::nullopt);
    if (start == StartFrom::kPrevious && from && can_continue(*from, *source.molecule, frame, target_atoms))
      result.start = StartFrom::kPrevious;
    const LastStep* const before = result.start == StartFrom::kPrevious ? &*from : nullptr;
    MappedStep mapped = map_as_needed(target, target_surface, frame, result, before, again, progress, clock);
    Certificate& certificate = mapped.result.certificate;
    if (options.round_trip) {
      const Mapping back = map_back(target, target_surface, mapped.frame, result.pairing, progress);
      certificate.round_trip = measure_round_trip(engine, mapped.mapping, back);
      clock.lap("round trip");
    } else {
      certificate.not_checked.emplace_back("round_trip");
    }
    std::optional<Readings> readings =
        evaluate(target, target_fields, target_surface, target_map, mapped, progress, clock);
    if (options.method == Method::kMorph) {
      last = after_morph(mapped.morphed, *target.molecule, frame.from_target, std::move(target_atoms), before,
                         certificate.unmatched_source);
    } else if (mapped.result.deform_report.converged) {
      last = after_deform(engine, regularized, mapped.mapping.mapped, std::move(target_atoms));
    }
    if (is_last) release(target_surface, target_map, mapped);
    if (readings) {
      find_causes(engine, *std::move(readings), {*source.molecule, *source_map.charges},
                  {*target.molecule, *target_charges}, options, mapped, progress);
      clock.lap("causes");
    }
    clock.finish();
    mapped.result.time_ms = std::move(time_ms);
    progress.report("metrics", 1.0);
    return std::move(mapped.result);
  }
};

Series::Series(Engine& engine, const CompareInput& source, const CompareOptions& options)
    : steps_(new Steps{engine, source, options}) {
  steps_->fields = make_fields(options.fields);
  steps_->source_fields = make_state_fields(steps_->fields, *source.molecule, {FieldSide::kSource, source.fields});
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
  if (state.target.size() != steps.source.molecule->size())
    throw InputError("the saved state is of a source with " + std::to_string(state.target.size()) +
                     " atoms, this one has " + std::to_string(steps.source.molecule->size()) +
                     "; start the series anew");
  steps.restored = std::move(state);
  if (steps.prepared) steps.adopt_restored_state();
}

CompareResult compare(Engine& engine, const CompareInput& source, const CompareInput& target,
                      const CompareOptions& options, const Progress& progress) {
  return Series(engine, source, options).finish(target, progress);
}

}  // namespace espdiff
