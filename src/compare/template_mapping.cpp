// template_mapping.cpp: the stages of a frame, in order.
#include "compare/template_mapping.h"

#include <cmath>
#include <limits>
#include <utility>

#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "base/error.h"
#include "causes/causes.h"
#include "certificate/certificate.h"
#include "certificate/result.h"
#include "certificate/trusted_area.h"
#include "compare/stages/fields.h"
#include "compare/stages/mapped_step.h"
#include "compare/stages/readings.h"
#include "engine/engine.h"
#include "field/field_kinds.h"
#include "field/read_field.h"
#include "input_checks/input_warnings.h"
#include "input_checks/map_check.h"
#include "input_checks/map_warnings.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"
#include "mapping/mapping.h"
#include "mapping/sample_outside.h"
#include "mapping/side_maps.h"
#include "mapping/stage_clock.h"
#include "motions/common_frame.h"
#include "motions/domain_motions.h"
#include "options/options.h"
#include "options/settings.h"

namespace espdiff {
namespace {

void check_options(const CompareOptions& options) {
  if (options.method != Method::kMorph)
    throw InputError(option("method", "deform") +
                     ": a template is mapped by the morph, whose correspondence does not slide; leave the option out");
  if (options.offsets_A.size() > 1)
    throw InputError(option("offset") +
                     ": a list of distances was given, and an ensemble has one value for a vertex; give one");
  if (options.round_trip)
    throw InputError(switched_on("round-trip") +
                     ": frames of an ensemble are not mapped back; check some of them by a comparison of the pair");
}

}  // namespace

struct TemplateMapping::Parts {
  Engine& engine;
  CompareInput source;
  CompareOptions options;
  RigidTransform to_common;
  Surface surface{};
  MeshPtr regularized{};
  std::size_t n_vertices = 0;
  GridPtr map{};
  TemplateSurface described{};
  std::vector<std::vector<double>> reading_weights{};  ///< [reading][vertex of the template]
  std::vector<Field> fields{};                         ///< besides the potential
  std::shared_ptr<const MapCheck> first_check{};       ///< of the given map that all others are to be like
  std::string first_name{};

  float isovalue() const { return static_cast<float>(options.surface.isovalue); }

  void prepare(const Progress& progress) {
    std::vector<std::pair<std::string, double>> times;
    StageClock clock(times);
    to_common = principal_frame(source.molecule->positions);
    surface = build_surface(engine, *source.molecule, to_common, options.surface, progress, clock);
    regularized = regularize(engine, surface, surface.mesh, options, progress, nullptr);
    n_vertices = engine.n_vertices(regularized);
    describe();
  }

  void describe() {
    const RigidTransform own = inverse(to_common);
    Mesh mesh = engine.download_shape(regularized);
    described.triangles = std::move(mesh.triangles);
    for (const Vec3f& p : mesh.positions) described.positions.push_back(own.apply(static_cast<Vec3d>(p)));
    for (const Vec3f& n : engine.level_set_normals(regularized, surface.atoms, isovalue()))
      described.normals.push_back(static_cast<Vec3f>(own.rotate(static_cast<Vec3d>(n))));
    described.residue = engine.vertex_residues(regularized, surface.atoms);
    described.summary = surface.summary;
  }

  MadeMap frame_map(const CompareInput& frame, const RigidTransform& to_map, const Progress& progress) {
    const PotentialUnit unit = unit_of(frame);
    if (map == nullptr && source.make_map)
      map = device_map(engine, source, inverse(to_common), {nullptr, false, options.offsets_A.front()}, unit,
                       options.temperature_K, progress)
                .map;
    const MapRequest request{frame.make_map ? map : nullptr, !reading_weights.empty(), options.offsets_A.front()};
    return device_map(engine, frame, to_map, request, unit, options.temperature_K, progress);
  }

  /// A frame's given map against its charges.
  /// @param check receives the regression
  std::vector<Warning> check_map(const CompareInput& frame, const Surface& target, const CommonFrame& common,
                                 std::shared_ptr<const MapCheck>& check, const Progress& progress) {
    std::vector<Warning> warnings;
    if (frame.map == nullptr) return warnings;
    const MapReferences references(engine, *frame.molecule, common.from_target, target, isovalue(),
                                   options.temperature_K, progress);
    for (Warning& warning : map_warnings("frame", *frame.map, references, options.temperature_K, check)) {
      warning.refuses = warning.refuses && !options.trust_maps;
      warnings.push_back(std::move(warning));
    }
    if (!options.trust_maps) refuse_other_kind(first_name, first_check, check);
    return warnings;
  }

  /// [vertex of the template] whether it has a counterpart.
  std::vector<bool> matched_vertices(const Mapping& mapping, const std::vector<Triangle>& triangles) const {
    std::vector<bool> matched(n_vertices, false);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (mapping.unmatched[t] != 0) continue;
      for (const std::uint32_t v : triangles[t]) {
        if (v < n_vertices) matched[v] = true;
      }
    }
    return matched;
  }

  /// The fields of a frame at the template's own vertices; NaN where they are unmatched, or have no value there.
  void read_fields(const StateFields& of_frame, const CompareInput& frame, const GridPtr& frame_map,
                   const Mapping& mapping, const Surface& target, const CommonFrame& common,
                   const std::vector<Triangle>& triangles, TemplateFrame& out) const {
    if (of_frame.empty()) return;
    const std::vector<bool> matched = matched_vertices(mapping, triangles);
    const FieldPlace place{engine,
                           mapping.mapped,
                           moved_outside(engine, mapping.mapped, target.atoms, isovalue(), options.offsets_A.front()),
                           *frame.molecule,
                           common.from_target,
                           target.atoms,
                           isovalue(),
                           options.surface.radius_scale,
                           frame_map};
    for (std::size_t f = 0; f < of_frame.size(); ++f) {
      std::vector<float> values = read_field(of_frame[f], place);
      values.resize(n_vertices);
      set_unmatched_to_nan(matched, values);
      out.fields.push_back(std::move(values));
      for (const std::string& note : of_frame[f].notes)
        out.field_notes.push_back("field " + fields[f].quantity.name + ": " + note);
    }
  }

  /// The potential at the template's own vertices; those that the morph added come after them.
  std::vector<float> sample(const GridPtr& frame_map, const CompareInput& frame, const Mapping& mapping,
                            const Surface& target, const std::vector<Triangle>& triangles, double& outside) const {
    const std::vector<bool> matched = matched_vertices(mapping, triangles);
    OutsideSamples samples =
        sample_outside(engine, frame_map, mapping.mapped, target.atoms, isovalue(), options.offsets_A.front());
    samples.values.resize(n_vertices);
    const std::size_t n_outside = count_outside(frame, samples.values, matched);
    outside = static_cast<double>(n_outside) / static_cast<double>(n_vertices);
    for (std::size_t v = 0; v < n_vertices; ++v) {
      if (!matched[v] || samples.inside[v] != 0) samples.values[v] = std::numeric_limits<float>::quiet_NaN();
    }
    return std::move(samples.values);
  }

  /// @param values of the frame: its potential, and where it is trusted
  std::vector<FrameReading> readings_of(const CompareInput& frame, const MadeMap& made, const Mapping& mapping,
                                        const Surface& target, const AtomPairing& pairing, const TemplateFrame& values,
                                        const Progress& progress) const {
    std::vector<FrameReading> readings;
    std::vector<PotentialReading> asked;
    const std::vector<Vec3f> points = engine.download_positions(
        moved_outside(engine, mapping.mapped, target.atoms, isovalue(), options.offsets_A.front()));
    for (const std::vector<double>& weights : reading_weights) {
      FrameReading reading;
      double area = 0;
      std::vector<double> shares(weights.size(), 0.0);
      for (std::size_t v = 0; v < weights.size(); ++v) {
        if (weights[v] == 0 || values.trusted[v] == 0 || !std::isfinite(values.potential[v])) continue;
        area += shares[v] = weights[v];
        reading.mean += weights[v] * static_cast<double>(values.potential[v]);
      }
      for (double& share : shares) share = area > 0 ? share / area : 0;
      asked.push_back(weighted_reading(points, shares, values.potential));
      reading.mean /= area;  // NaN where nothing of it has a value
      readings.push_back(std::move(reading));
    }
    const auto found = engine.contributions(made.map, asked, {}, progress);
    const std::vector<std::int32_t> partner = paired_residues(*source.molecule, *frame.molecule, pairing);
    for (std::size_t r = 0; r < readings.size(); ++r) {
      const ResidueSums sums = sum_by_residue(*frame.molecule, *made.charges, found[r]);
      readings[r].others = sums.all;
      for (const std::int32_t residue : partner) {
        readings[r].of_residue.push_back(residue < 0 ? 0 : sums.of_residue[static_cast<std::size_t>(residue)]);
        readings[r].others -= readings[r].of_residue.back();
      }
    }
    return readings;
  }
};

TemplateMapping::TemplateMapping(Engine& engine, const CompareInput& source, const CompareOptions& options,
                                 const Progress& progress)
    : parts_(new Parts{engine, source, options, {}}) {
  check_options(options);
  refuse_patches_of(options, "an ensemble");
  if (options.leave_out_turned)
    throw InputError("what turned is not looked at where one template is mapped onto all states; leave " +
                     option("leave-out-turned") + " away");
  parts_->fields = make_fields(options.fields);
  parts_->prepare(progress);
}

TemplateMapping::~TemplateMapping() = default;

const TemplateSurface& TemplateMapping::surface() const { return parts_->described; }

void TemplateMapping::take_apart(std::vector<std::vector<double>> weights) {
  parts_->reading_weights = std::move(weights);
}

void TemplateMapping::check_kind(const CompareInput& frame, const std::string& name, const Progress& progress) {
  Parts& p = *parts_;
  if (frame.map == nullptr) return;
  std::vector<std::pair<std::string, double>> times;
  StageClock clock(times);
  const CommonFrame common = align(*p.source.molecule, *frame.molecule, p.options).frame;
  const Surface surface =
      build_surface(p.engine, *frame.molecule, common.from_target, p.options.surface, progress, clock);
  std::shared_ptr<const MapCheck> check;
  p.check_map(frame, surface, common, check, progress);
  if (p.first_check || !check) return;
  if (check->best().correlation < kLeastMapCorrelation) return;
  p.first_check = check;
  p.first_name = name;
}

std::unique_ptr<TemplateMapping> TemplateMapping::beside(Engine& engine, const Progress& progress) const {
  auto other = std::make_unique<TemplateMapping>(engine, parts_->source, parts_->options, progress);
  Parts& p = *other->parts_;
  p.reading_weights = parts_->reading_weights;
  p.first_check = parts_->first_check;
  p.first_name = parts_->first_name;
  return other;
}

TemplateFrame TemplateMapping::map(const CompareInput& frame, const Progress& progress) {
  Parts& p = *parts_;
  TemplateFrame out;
  StageClock clock(out.time_ms);
  const StateFields of_frame = make_state_fields(p.fields, *frame.molecule, {FieldSide::kFrame, frame.fields});
  const AlignedStates aligned = align(*p.source.molecule, *frame.molecule, p.options);
  const CommonFrame& common = aligned.frame;
  std::vector<Warning> warnings = input_warnings(*p.source.molecule, *frame.molecule, aligned.alignment);
  clock.lap("align");
  const MadeMap made = p.frame_map(frame, inverse(common.from_target), progress);
  clock.lap("potential");
  const Surface target =
      build_surface(p.engine, *frame.molecule, common.from_target, p.options.surface, progress, clock);
  std::shared_ptr<const MapCheck> check;
  for (Warning& warning : p.check_map(frame, target, common, check, progress)) warnings.push_back(std::move(warning));
  const StatesToMap states{p.engine,        p.options, *p.source.molecule, p.surface, p.regularized, false,
                           *frame.molecule, target,    aligned.alignment};
  MappedStep step = map_once(states, common, {}, KeptTurns::kAll, progress, clock);
  const std::vector<Triangle>& triangles = step.surface.triangles;
  MeasuredSurface measured;
  Certificate& certificate = measured.certificate = std::move(step.certificate);
  certificate.trusted = sum_trusted(step.surface, step.areas, {}, certificate.unmatched_target);
  out.trusted = trusted_vertices(step.surface);
  out.trusted.resize(p.n_vertices);  // those that the morph added come after them
  out.potential = p.sample(made.map, frame, step.mapping, target, triangles, certificate.outside_maps);
  p.read_fields(of_frame, frame, made.map, step.mapping, target, common, triangles, out);
  if (!p.reading_weights.empty())
    out.readings = p.readings_of(frame, made, step.mapping, target, aligned.alignment.pairing, out, progress);
  judge(measured, warnings, *p.source.molecule, p.options.required_share);
  out.unit = unit_of(frame);
  out.rmsd_A = aligned.alignment.rmsd_A;
  out.unmatched_template = certificate.unmatched_source;
  out.unmatched_frame = certificate.unmatched_target;
  out.distance_A = certificate.mapped_to_target.mean_within_limit;
  out.same_residue_area_fraction = certificate.same_residue_area_fraction;
  out.trustworthy = certificate.trustworthy;
  if (!certificate.reasons.empty()) out.reason = certificate.reasons.front().plain();
  clock.lap("sample");
  clock.finish();
  return out;
}

}  // namespace espdiff
