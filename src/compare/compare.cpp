// compare.cpp: the stages of a comparison, in order.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "align/compared_chains.h"
#include "align/protonation.h"
#include "align/superpose.h"
#include "base/error.h"
#include "base/handles.h"
#include "compare/atom_paths.h"
#include "compare/build_surface.h"
#include "compare/certificate.h"
#include "compare/common_frame.h"
#include "compare/compare.h"
#include "compare/domain_motions.h"
#include "compare/input.h"
#include "compare/input_warnings.h"
#include "compare/last_step.h"
#include "compare/map_by_deform.h"
#include "compare/map_by_morph.h"
#include "compare/map_recipe.h"
#include "compare/map_warnings.h"
#include "compare/mapping.h"
#include "compare/options.h"
#include "compare/own_potentials.h"
#include "compare/paired_residues.h"
#include "compare/place_patch.h"
#include "compare/region_result.h"
#include "compare/residue_rows.h"
#include "compare/result.h"
#include "compare/round_trip.h"
#include "compare/sample_outside.h"
#include "compare/series.h"
#include "compare/side_maps.h"
#include "compare/slip.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"

namespace espdiff {

namespace {

/// [vertex] whether it lies in a matched triangle.
std::vector<bool> is_matched(const MappedSurface& s) {
  if (s.unmatched.empty()) return std::vector<bool>(s.positions.size(), true);
  std::vector<bool> has(s.positions.size(), false);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.unmatched[t] != 0) continue;
    for (const std::uint32_t v : s.triangles[t]) has[v] = true;
  }
  return has;
}

/// A region or patch: where it is, and its numbers.
struct MeasuredPart {
  SurfacePart place;
  std::shared_ptr<CompareResult> result;
  std::shared_ptr<const PatchPlacement> placement;  // of an earlier patch
};

/// Sets unmatched vertices to NaN.
void set_unmatched_to_nan(const std::vector<bool>& kept, std::vector<float>& values) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!kept[v]) values[v] = std::numeric_limits<float>::quiet_NaN();
  }
}

std::vector<Vec3f> rotated(std::vector<Vec3f> normals, const RigidTransform& to_frame) {
  for (Vec3f& n : normals) n = static_cast<Vec3f>(to_frame.rotate(static_cast<Vec3d>(n)));
  return normals;
}

/// @param moved the source, moved by its rigid domains
void download_surface(Engine& engine, const MeshPtr& source, const AtomsPtr& source_atoms, const MeshPtr& moved,
                      const MeshPtr& mapped, const AtomsPtr& target_atoms, float isovalue, const CommonFrame& frame,
                      MappedSurface& surface) {
  const RigidTransform to_source = inverse(frame.from_source), to_target = inverse(frame.from_target);
  Mesh mapped_mesh = engine.download_shape(mapped);
  surface.triangles = std::move(mapped_mesh.triangles);
  for (const Vec3f& p : mapped_mesh.positions) surface.positions.push_back(to_target.apply(static_cast<Vec3d>(p)));
  for (const Vec3f& p : engine.download_positions(source))
    surface.source_positions.push_back(to_source.apply(static_cast<Vec3d>(p)));
  surface.normals = rotated(engine.level_set_normals(mapped, target_atoms, isovalue), to_target);
  surface.source_normals = rotated(engine.level_set_normals(source, source_atoms, isovalue), to_source);
  surface.displacement = engine.download(engine.displacement(moved, mapped));
}

}  // namespace

/// The stages of a step, and the state kept between steps; all in the common frame, which is the source's.
struct Series::Steps {
  Engine& engine;
  CompareInput source;
  CompareOptions options;
  bool prepared = false;
  Surface surface{};
  MeshPtr regularized{};
  DeformReport regularize_report{};
  PotentialUnit unit = PotentialUnit::kUnknown;  ///< of the source's map
  MadeMap source_map{};                          ///< made by the first step
  std::optional<LastStep> last{};                ///< empty if the next step starts from the source
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
    Steps back{engine, target, options, true, target_surface};
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
      mapping =
          mapping_of(engine, back.morph(*source.molecule, surface, reversed, paths, nullptr, scratch, progress, clock));
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
  MorphResult morph(const Molecule& target, const Surface& target_surface, const CommonFrame& frame,
                    const std::vector<MovingAtom>& paths, const LastStep* from, CompareResult& result,
                    const Progress& progress, StageClock& clock) const {
    const MorphOptions morph = morph_options(options);
    MorphResult morphed;
    if (from != nullptr) {
      const auto step_paths =
          paths_from(*from, *source.molecule, target, frame.from_target, result.domains, options, progress);
      morphed = engine.continue_morph(*from->morphed, step_paths, surface.atoms, target_surface.atoms, morph, "morph",
                                      progress);
    } else {
      morphed = engine.morph(regularized, paths, surface.atoms, target_surface.atoms, morph, "morph", progress);
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

  /// The target's map, null where there is none; the source's too, unless it is there already.
  GridPtr make_maps(const CompareInput& target, const CommonFrame& frame, CompareResult& result,
                    const Progress& progress) {
    if (!has_map(target)) return nullptr;
    const PotentialUnit wanted = common_unit(source, target);
    const double temperature_K = options.temperature_K;
    if (source_map.map == nullptr || wanted != unit) {
      source_map = device_map(engine, source, inverse(frame.from_source), nullptr, wanted, temperature_K, progress);
      unit = wanted;
    }
    if (source.make_map) result.source_recipe = std::make_shared<const MapRecipe>(source_map.recipe);
    // An iteration may start from the source's potential, whatever steps were made before: the bits of a step do not
    // depend on them.
    const GridPtr before = source.make_map ? source_map.map : nullptr;
    MadeMap made = device_map(engine, target, inverse(frame.from_target), before, wanted, temperature_K, progress);
    if (target.make_map) result.target_recipe = std::make_shared<const MapRecipe>(std::move(made.recipe));
    return made.map;
  }

  /// Both potentials at one distance outside the surfaces, NaN where a vertex does not count; says in `counted` why.
  std::pair<std::vector<float>, std::vector<float>> sample_both(const CompareInput& target, const GridPtr& target_map,
                                                                const Mapping& mapping, const AtomsPtr& target_atoms,
                                                                const std::vector<bool>& kept,
                                                                OffsetMetrics& counted) const {
    const float isovalue = static_cast<float>(options.surface.isovalue);
    OutsideSamples at_source = sample_outside(engine, source_map.map, mapping.source, surface.atoms, isovalue,
                                              counted.offset_A),
                   at_target =
                       sample_outside(engine, target_map, mapping.mapped, target_atoms, isovalue, counted.offset_A);
    counted.n_outside_source_map = count_outside(source, at_source.values, kept);
    counted.n_outside_target_map = count_outside(target, at_target.values, kept);
    for (std::size_t v = 0; v < kept.size(); ++v) {
      if (at_source.inside[v] != 0) at_source.values[v] = std::numeric_limits<float>::quiet_NaN();
      if (at_target.inside[v] != 0) at_target.values[v] = std::numeric_limits<float>::quiet_NaN();
      counted.n_inside_source += kept[v] && at_source.inside[v] != 0 ? 1 : 0;
      counted.n_inside_target += kept[v] && at_target.inside[v] != 0 ? 1 : 0;
    }
    return {std::move(at_source.values), std::move(at_target.values)};
  }

  /// Samples both potentials and computes the metrics of their difference, at each distance outside the surfaces.
  void compare_potentials(const CompareInput& target, const GridPtr& target_map, const Mapping& mapping,
                          const MeshPtr& moved, const AtomsPtr& target_atoms, const std::vector<MeasuredPart>& parts,
                          CompareResult& result) {
    MappedSurface& s = result.surface;
    const std::vector<bool> kept = is_matched(s);
    std::vector<float> excluded(s.corrupt.begin(), s.corrupt.end());
    for (std::size_t t = 0; t < mapping.unmatched.size(); ++t)
      excluded[t] = std::max(excluded[t], mapping.unmatched[t]);
    const ScalarsPtr left_out = engine.upload_scalars(excluded),
                     path_length = engine.upload_scalars(mapping.path_length);
    result.unit = unit;
    result.has_potential = true;
    for (const double offset_A : options.offsets_A) {
      OffsetMetrics at;
      at.offset_A = offset_A;
      auto [of_source, of_target] = sample_both(target, target_map, mapping, target_atoms, kept, at);
      const ScalarsPtr at_source = engine.upload_scalars(of_source), at_target = engine.upload_scalars(of_target);
      at.metrics = engine.compare(moved, mapping.mapped, at_source, at_target, left_out, path_length);
      result.by_offset.push_back(at);
      for (const MeasuredPart& part : parts)
        compare_part(mapping, moved, at_source, at_target, excluded, part.place.outside, path_length, at.offset_A,
                     *part.result);
      if (result.by_offset.size() > 1) continue;
      result.metrics = at.metrics;
      result.n_outside_source_map = at.n_outside_source_map;
      result.n_outside_target_map = at.n_outside_target_map;
      result.metrics_all =
          engine.compare(moved, mapping.mapped, at_source, at_target,
                         mapping.unmatched.empty() ? nullptr : engine.upload_scalars(mapping.unmatched), path_length);
      if (!s.slip.empty()) {
        std::vector<float> slipped = slipped_triangles(s);
        for (std::size_t t = 0; t < slipped.size(); ++t) slipped[t] = std::max(slipped[t], excluded[t]);
        result.metrics_without_slip =
            engine.compare(moved, mapping.mapped, at_source, at_target, engine.upload_scalars(slipped), path_length);
      }
      s.potential_source = std::move(of_source);
      s.potential_target = std::move(of_target);
      set_unmatched_to_nan(kept, s.potential_target);
    }
  }

  /// The metrics of a part at one distance.
  /// @param excluded [triangle] that do not count anywhere
  void compare_part(const Mapping& mapping, const MeshPtr& moved, const ScalarsPtr& at_source,
                    const ScalarsPtr& at_target, const std::vector<float>& excluded, const std::vector<float>& outside,
                    const ScalarsPtr& path_length, double offset_A, CompareResult& part) {
    std::vector<float> flags = outside, unmatched = outside;
    for (std::size_t t = 0; t < flags.size(); ++t) flags[t] = std::max(flags[t], excluded[t]);
    for (std::size_t t = 0; t < mapping.unmatched.size(); ++t)
      unmatched[t] = std::max(unmatched[t], mapping.unmatched[t]);
    OffsetMetrics at;
    at.offset_A = offset_A;
    at.metrics = engine.compare(moved, mapping.mapped, at_source, at_target, engine.upload_scalars(flags), path_length);
    part.has_potential = true;
    part.unit = unit;
    part.by_offset.push_back(at);
    if (part.by_offset.size() > 1) return;
    part.metrics = at.metrics;
    part.metrics_all =
        engine.compare(moved, mapping.mapped, at_source, at_target, engine.upload_scalars(unmatched), path_length);
  }

  /// Finds the part of the mapping that is matched on the target's surface; drops unmatched closed cavities.
  void find_matched(Mapping& mapping, const Surface& target_surface) const {
    find_matched_part(engine, mapping, target_surface.atoms, target_surface.mesh,
                      static_cast<float>(options.surface.isovalue));
    if (options.method == Method::kMorph && !options.surface.cavities) drop_closed_cavities(engine, mapping);
  }

  /// Finds the matched part and certifies it.
  void check(Mapping& mapping, const Surface& target_surface, CompareResult& result, const Progress& progress,
             StageClock& clock) const {
    progress.report("certificate", 0.0);
    find_matched(mapping, target_surface);
    result.area_mapped_A2 = mapping.fit.area_A2;
    std::vector<std::string> not_checked = std::move(result.certificate.not_checked);
    result.certificate = certify(engine, mapping, target_surface.mesh);
    result.certificate.not_checked = std::move(not_checked);
    result.certificate.converged = options.method == Method::kMorph || result.deform_report.converged;
    clock.lap("certificate");
  }

  /// [residue] the target's potentials on its own surface, at the first of the offsets.
  std::vector<OwnPotential> own_of_target(const GridPtr& map, const Surface& target_surface,
                                          const std::vector<std::int32_t>& source_of) const {
    OutsideSamples samples = sample_outside(engine, map, target_surface.mesh, target_surface.atoms,
                                            static_cast<float>(options.surface.isovalue), options.offsets_A.front());
    for (std::size_t v = 0; v < samples.values.size(); ++v) {
      if (samples.inside[v] != 0) samples.values[v] = std::numeric_limits<float>::quiet_NaN();
    }
    return own_potentials(engine.download_shape(target_surface.mesh),
                          engine.vertex_residues(target_surface.mesh, target_surface.atoms), samples.values, source_of);
  }

  /// Each residue's difference from its potentials on its own surfaces, and how the mapped differences agree.
  void check_against_own(const CompareInput& target, const GridPtr& target_map, const Mapping& mapping,
                         const Surface& target_surface, const std::vector<std::int32_t>& target_of,
                         CompareResult& result) const {
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
    set_own_differences(result.residues, own, own_of_target(target_map, target_surface, source_of), target_of);
    const ResidueCheck check = check_residues(result.residues, own);
    if (check.n_residues >= kLeastComparedResidues)
      result.certificate.residues = check;
    else
      result.certificate.not_checked.emplace_back("residues");
  }

  /// Slip by vertex and over the area.
  void measure_slip(const Mapping& mapping, const MeshPtr& target, const std::vector<MovingAtom>& paths,
                    const std::vector<bool>& kept, CompareResult& result) const {
    if (paths.empty()) {
      result.certificate.not_checked.emplace_back("slip");
      return;
    }
    MappedSurface& s = result.surface;
    s.slip = engine.slip(mapping.source, mapping.mapped, target, paths);
    set_unmatched_to_nan(kept, s.slip);
    result.certificate.slip = summarize_slip(s, matched_areas(s));
  }

  /// Fills in the results of the mapping: per-vertex arrays, potentials, metrics, residues, and the verdict.
  void evaluate(const CompareInput& target, const CommonFrame& frame, const Surface& target_surface,
                const GridPtr& target_map, const Mapping& mapping, const std::vector<MovingAtom>& paths,
                CompareResult& result, const Progress& progress, StageClock& clock) {
    progress.report("metrics", 0.0);
    MappedSurface& s = result.surface;
    const MeshPtr moved = frame.domains.carry(engine, mapping.source, surface.atoms);
    download_surface(engine, mapping.source, surface.atoms, moved, mapping.mapped, target_surface.atoms,
                     static_cast<float>(options.surface.isovalue), frame, s);
    s.unmatched.assign(mapping.unmatched.begin(), mapping.unmatched.end());
    s.corrupt = to_full_mesh(engine.download(mapping.fit.corrupt), mapping.unmatched);
    s.path_length = mapping.path_length;
    const std::vector<bool> kept = is_matched(s);
    set_unmatched_to_nan(kept, s.displacement);
    set_unmatched_to_nan(kept, s.path_length);
    s.residue = engine.vertex_residues(mapping.source, surface.atoms);
    measure_slip(mapping, target_surface.mesh, paths, kept, result);
    const std::vector<std::int32_t> target_of = paired_residues(*source.molecule, *target.molecule, result.pairing);
    const std::vector<std::int32_t> mapped_residue = engine.vertex_residues(mapping.mapped, target_surface.atoms);
    result.certificate.same_residue_area_fraction = same_residue_share(s, s.residue, mapped_residue, target_of);
    const std::vector<MeasuredPart> parts =
        measure_parts(target, target_surface, mapping, target_of, mapped_residue, result);
    result.uncovered =
        uncovered_surface(engine.download(target_surface.mesh),
                          engine.download(result.certificate.target_to_mapped.beyond), inverse(frame.from_target));
    if (target_map != nullptr) {
      compare_potentials(target, target_map, mapping, moved, target_surface.atoms, parts, result);
      result.certificate.outside_maps = share_outside(s, matched_areas(s));
    }
    result.residues = residue_rows(s, source.molecule->residues.size(), result.has_potential);
    check_against_own(target, target_map, mapping, target_surface, target_of, result);
    describe_chains(target, target_of, result);
    judge(result, *source.molecule, options);
    for (const MeasuredPart& part : parts) finish_part(part, result);
    clock.lap("metrics");
  }

  /// Which chains and which protonation states were compared.
  void describe_chains(const CompareInput& target, const std::vector<std::int32_t>& target_of,
                       CompareResult& result) const {
    const Molecule &a = *source.molecule, &b = *target.molecule;
    result.chains = compared_chains(a, b, target_of);
    result.source_copies = repeated_chains(a);
    result.target_copies = repeated_chains(b);
    if (a.charges.empty() || b.charges.empty()) return;
    result.protonation = protonation_differences(a, b, target_of);
    if (!result.protonation.empty()) result.warnings.push_back({protonation_warning(result.protonation, a), false});
  }

  /// The region and the patches, which become part of the result; without potentials, and not judged.
  std::vector<MeasuredPart> measure_parts(const CompareInput& target, const Surface& target_surface,
                                          const Mapping& mapping, const std::vector<std::int32_t>& target_of,
                                          const std::vector<std::int32_t>& mapped_residue,
                                          CompareResult& result) const {
    std::vector<MeasuredPart> parts;
    const MappedSurface& s = result.surface;
    const auto measure = [&](const std::vector<std::uint8_t>& inside, const std::vector<std::uint8_t>& residues) {
      SurfacePart place = make_part(inside, residues, s, target_of, target.molecule->residues.size());
      auto part = part_result(engine, place, mapping, target_surface, static_cast<float>(options.surface.isovalue),
                              s.residue, mapped_residue, target_of, result, *source.molecule, *target.molecule);
      parts.push_back({std::move(place), part, nullptr});
      return part;
    };
    const std::vector<std::uint8_t>& region = source.parts.region;
    if (!region.empty()) result.region = measure(vertices_of(s.residue, region), region);
    for (const SurfacePatch& patch : source.parts.patches) {
      if (patch.earlier == nullptr) {
        result.patches.push_back({patch.name, measure(vertices_of(s.residue, patch.residues), patch.residues)});
        continue;
      }
      const ResidueSurface on{s.source_positions, s.triangles, s.residue, source.molecule->residues};
      const PlacedPatch placed = place_patch(*patch.earlier, on, source.molecule->name);
      result.patches.push_back(
          {patch.name, measure(placed.inside, residues_in_patch(placed.inside, on)), placed.placement});
      parts.back().placement = placed.placement;
    }
    return parts;
  }

  /// A part's residues, vertices outside a map, and verdict.
  void finish_part(const MeasuredPart& measured, CompareResult& result) const {
    const SurfacePart& place = measured.place;
    CompareResult& part = *measured.result;
    for (const Warning& warning : result.warnings) {
      if (warning.refuses) part.warnings.push_back(warning);
    }
    for (const ResidueRow& row : result.residues) {
      if (place.source[row.residue] != 0) part.residues.push_back(row);
    }
    std::vector<bool> in_part(result.surface.positions.size(), false);
    for (std::size_t t = 0; t < place.outside.size(); ++t) {
      const bool counts =
          place.outside[t] == 0 && (result.surface.unmatched.empty() || result.surface.unmatched[t] == 0);
      for (const std::uint32_t v : result.surface.triangles[t]) in_part[v] = in_part[v] || counts;
    }
    std::size_t n = 0;
    for (std::size_t v = 0; v < in_part.size(); ++v) {
      if (!in_part[v]) continue;
      ++n;
      if (!result.has_potential || result.n_outside_source_map + result.n_outside_target_map == 0) continue;
      part.n_outside_source_map += std::isnan(result.surface.potential_source[v]) ? 1 : 0;
      part.n_outside_target_map += std::isnan(result.surface.potential_target[v]) ? 1 : 0;
    }
    const double n_outside = static_cast<double>(std::max(part.n_outside_source_map, part.n_outside_target_map));
    part.certificate.outside_maps = n > 0 ? n_outside / static_cast<double>(n) : 0;
    if (!judge_missing_part(part, measured.placement.get())) {
      judge(part, *source.molecule, options);
      if (measured.placement != nullptr) judge_placement(part, *measured.placement);
    }
  }

  void check_given_maps(const CompareInput& target, CompareResult& result) const {
    bool checked = true;
    for (Warning& warning : map_warnings(source, target, checked)) result.warnings.push_back(std::move(warning));
    if (!checked) result.certificate.not_checked.emplace_back("maps_fit_molecules");
  }

  /// Runs the stages in order; see Series::step().
  CompareResult step(const CompareInput& target, StartFrom start, const Progress& progress) {
    CompareResult result;
    StageClock clock(result.time_ms);
    check_maps(source, target);  // before any work
    progress.report("align", 0.0);
    const CommonFrame frame = align(*source.molecule, *target.molecule, options, result);
    result.warnings = input_warnings(*source.molecule, *target.molecule, result);
    check_given_maps(target, result);
    clock.lap("align");
    const GridPtr target_map = make_maps(target, frame, result, progress);
    if (target_map != nullptr) clock.lap("potential");

    prepare(frame.from_source, progress, clock);
    const Surface target_surface =
        build_surface(engine, *target.molecule, frame.from_target, options.surface, progress, clock);
    result.source_surface = surface.summary;
    result.target_surface = target_surface.summary;
    result.regularize_report = regularize_report;

    std::vector<Vec3d> target_atoms =
        counterparts(*source.molecule, *target.molecule, result.pairing, frame.from_target);
    const std::optional<LastStep> from = std::exchange(last, std::nullopt);
    if (start == StartFrom::kPrevious && from && can_continue(*from, *source.molecule, frame, target_atoms))
      result.start = StartFrom::kPrevious;
    const LastStep* const before = result.start == StartFrom::kPrevious ? &*from : nullptr;
    Mapping mapping;
    MorphResult morphed;
    // deform needs no pairs; the morph says what it misses.
    const bool has_paths = options.method == Method::kMorph || !result.pairing.pairs.empty();
    const std::vector<MovingAtom> paths =
        has_paths ? paths_to(*target.molecule, frame, result.pairing, progress) : std::vector<MovingAtom>();
    clock.lap("atom paths");
    if (options.method == Method::kMorph) {
      morphed = morph(*target.molecule, target_surface, frame, paths, before, result, progress, clock);
      mapping = mapping_of(engine, morphed);
    } else {
      const MeshPtr begin =
          before != nullptr ? before->mapped : frame.domains.carry(engine, regularized, surface.atoms);
      mapping = deform(target_surface, begin, frame, result, progress, clock);
    }
    check(mapping, target_surface, result, progress, clock);
    if (options.round_trip) {
      const Mapping back = map_back(target, target_surface, frame, result.pairing, progress);
      result.certificate.round_trip = measure_round_trip(engine, mapping, back);
      clock.lap("round trip");
    } else {
      result.certificate.not_checked.emplace_back("round_trip");
    }
    evaluate(target, frame, target_surface, target_map, mapping, paths, result, progress, clock);
    if (options.method == Method::kMorph) {
      last = after_morph(morphed, *target.molecule, frame.from_target, std::move(target_atoms), before,
                         result.certificate.unmatched_source);
    } else if (result.deform_report.converged) {
      last = after_deform(engine, regularized, mapping.mapped, std::move(target_atoms));
    }
    clock.finish();
    progress.report("metrics", 1.0);
    return result;
  }
};

Series::Series(Engine& engine, const CompareInput& source, const CompareOptions& options)
    : steps_(new Steps{engine, source, options}) {}
Series::~Series() = default;

CompareResult Series::step(const CompareInput& target, StartFrom start, const Progress& progress) {
  try {
    return steps_->step(target, start, progress);
  } catch (...) {
    steps_->last.reset();
    steps_->restored.reset();
    throw;
  }
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
  return Series(engine, source, options).step(target, StartFrom::kSource, progress);
}

}  // namespace espdiff
