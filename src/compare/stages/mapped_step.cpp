// mapped_step.cpp: the stages of one mapping, in order.
#include "compare/stages/mapped_step.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "align/geometry/superpose.h"
#include "align/paired_residues.h"
#include "certificate/certificate.h"
#include "certificate/residue_rows.h"
#include "certificate/slip.h"
#include "certificate/turned_side_chains.h"
#include "engine/engine.h"
#include "mapping/map_by_deform.h"
#include "mapping/map_by_morph.h"
#include "motions/atom_paths.h"
#include "options/options.h"

namespace espdiff {
namespace {

std::vector<bool> matched_vertices(const MappedSurface& s) {
  if (s.unmatched.empty()) return std::vector<bool>(s.positions.size(), true);
  std::vector<bool> has(s.positions.size(), false);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.unmatched[t] != 0) continue;
    for (const std::uint32_t v : s.triangles[t]) has[v] = true;
  }
  return has;
}

/// @param points in the common frame
std::vector<Vec3d> transformed(const std::vector<Vec3f>& points, const RigidTransform& to_frame) {
  std::vector<Vec3d> result(points.size());
  const auto n = static_cast<std::ptrdiff_t>(points.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto v = static_cast<std::size_t>(i);
    result[v] = to_frame.apply(static_cast<Vec3d>(points[v]));
  }
  return result;
}

void download_surface(Engine& engine, const MappedStep& step, MappedSurface& surface) {
  const RigidTransform to_source = inverse(step.frame.from_source), to_target = inverse(step.frame.from_target);
  const Mapping& mapping = step.mapping;
  Mesh mapped = engine.download_shape(mapping.mapped);
  surface.triangles = std::move(mapped.triangles);
  surface.positions = transformed(mapped.positions, to_target);
  surface.source_positions = transformed(engine.download_positions(mapping.source), to_source);
  surface.displacement = engine.download(engine.displacement(step.moved, mapping.mapped));
  surface.unmatched.assign(mapping.unmatched.begin(), mapping.unmatched.end());
  surface.corrupt = to_full_mesh(engine.download(mapping.fit.corrupt), mapping.unmatched);
  surface.path_length = mapping.path_length;
}

std::vector<Vec3f> rotated(std::vector<Vec3f> normals, const RigidTransform& to_frame) {
  const auto n = static_cast<std::ptrdiff_t>(normals.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    Vec3f& normal = normals[static_cast<std::size_t>(i)];
    normal = static_cast<Vec3f>(to_frame.rotate(static_cast<Vec3d>(normal)));
  }
  return normals;
}

std::vector<MovingAtom> paths_of(const StatesToMap& states, const CommonFrame& frame, const Progress& progress) {
  return atom_paths(states.source, states.target, states.alignment.pairing, frame.from_source, frame.from_target,
                    frame.followed, states.options.surface.radius_scale, progress);
}

MorphResult morph(const StatesToMap& states, const MappedStep& step, const MappingStart& start,
                  const Progress& progress) {
  Engine& engine = states.engine;
  const AtomsPtr &source_atoms = states.source_surface.atoms, &target_atoms = states.target_surface.atoms;
  MorphOptions options = morph_options(states.options);
  options.max_step_A *= start.step_factor;
  if (start.before == nullptr)
    return engine.morph(states.regularized, step.paths, source_atoms, target_atoms, options, start.stage, progress);
  const auto step_paths = paths_from(*start.before, states.source, states.target, step.frame.from_target,
                                     states.alignment.domains, states.options, progress);
  return engine.continue_morph(*start.before->morphed, step_paths, source_atoms, target_atoms, options, start.stage,
                               progress);
}

void step_by_morph(const StatesToMap& states, const MappingStart& start, MappedStep& step, const Progress& progress,
                   StageClock& clock) {
  step.morphed = morph(states, step, start, progress);
  step.report.morph = step.morphed.report;
  step.report.morph.n_vertices_added =
      states.engine.n_vertices(step.morphed.source) - states.engine.n_vertices(states.regularized);
  clock.lap("morph");
  step.mapping = mapping_of(states.engine, step.morphed);
}

void step_by_deform(const StatesToMap& states, const MappingStart& start, MappedStep& step, const Progress& progress,
                    StageClock& clock) {
  Engine& engine = states.engine;
  const DomainMotions& domains = step.frame.domains;
  const MeshPtr begin = start.before != nullptr
                            ? start.before->mapped
                            : domains.carry(engine, states.regularized, states.source_surface.atoms);
  const FieldPtr field =
      make_field(engine, states.source_surface, states.target_surface, states.options, progress, &step.report.flow);
  clock.lap("field");
  step.mapping = map_by_deform(engine, states.source_surface, states.regularized, states.target_surface, begin, domains,
                               field, states.options, progress, step.report.deform, step.report.n_vertices_subdivided);
  clock.lap("deform");
}

void map_surface(const StatesToMap& states, const MappingStart& start, MappedStep& step, const Progress& progress,
                 StageClock& clock) {
  if (states.options.method == Method::kMorph) {
    step_by_morph(states, start, step, progress, clock);
  } else {
    step_by_deform(states, start, step, progress, clock);
  }
}

/// Finds the part of the mapping that is matched on the target's surface; drops unmatched closed cavities.
void find_matched(const StatesToMap& states, Mapping& mapping) {
  find_matched_part(states.engine, mapping, states.target_surface.atoms, states.target_surface.mesh, states.isovalue());
  if (states.has_cavities && !states.options.surface.cavities) drop_closed_cavities(states.engine, mapping);
}

/// Marks the vertices of what turned that lie off the place where it carried them. Nothing is asked of the device where
/// nothing turned.
void mark_turned(const StatesToMap& states, const MappedStep& step, MappedSurface& s) {
  s.turned.assign(s.positions.size(), 0);
  const std::vector<TurnedAtom> atoms = turned_atoms(states.source, states.target, states.alignment.pairing);
  const auto has_turned = [](const TurnedAtom& atom) { return atom.turn != Turn::kNone; };
  if (std::none_of(atoms.begin(), atoms.end(), has_turned)) return;
  std::vector<std::int32_t> numbers(atoms.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  const std::vector<std::int32_t> owner = vertex_labels(states.engine, states.source_surface, step.mapping.source,
                                                        states.source, step.frame.from_source, numbers);
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (owner[v] < 0) continue;
    const TurnedAtom& atom = atoms[static_cast<std::size_t>(owner[v])];
    if (!has_turned(atom)) continue;
    const double off_A = norm(atom.carried.apply(s.source_positions[v]) - s.positions[v]);
    const bool is_far = atom.turn == Turn::kSideChain && off_A > kFarTurn_A;
    if (off_A > kLargeSlip_A) s.turned[v] = static_cast<std::uint8_t>(is_far ? Turn::kFarSideChain : atom.turn);
  }
}

/// Downloads a certified mapping and finds its residues, its slip, and where it is trusted.
void describe(const StatesToMap& states, KeptTurns kept, MappedStep& step) {
  Engine& engine = states.engine;
  const Mapping& mapping = step.mapping;
  MappedSurface& s = step.surface;
  step.moved = step.frame.domains.carry(engine, mapping.source, states.source_surface.atoms);
  download_surface(engine, step, s);
  step.is_matched = matched_vertices(s);
  step.areas = surface_areas(s);
  set_unmatched_to_nan(step.is_matched, s.displacement);
  set_unmatched_to_nan(step.is_matched, s.path_length);
  s.residue = engine.vertex_residues(mapping.source, states.source_surface.atoms);
  if (!step.paths.empty()) {
    s.slip = engine.slip(mapping.source, mapping.mapped, states.target_surface.mesh, step.paths);
    set_unmatched_to_nan(step.is_matched, s.slip);
    step.certificate.slip = summarize_slip(s, matched_areas(s, step.areas));
  }
  s.target_residue = engine.vertex_residues(mapping.mapped, states.target_surface.atoms);
  const std::vector<std::int32_t> target_of = paired_residues(states.source, states.target, states.alignment.pairing);
  step.certificate.same_residue_area_fraction =
      same_residue_share(s, step.areas, s.residue, s.target_residue, target_of);
  mark_turned(states, step, s);
  s.why = why_of_mapping(s, target_of, kept);
  step.rows = residue_rows(s, step.areas, states.source.residues.size(), false);
}

}  // namespace

float StatesToMap::isovalue() const { return static_cast<float>(options.surface.isovalue); }

RegularizedSurface regularized_for(Engine& engine, const Surface& surface, const CompareOptions& options,
                                   const Progress& progress) {
  RegularizedSurface regularized;
  const MeshPtr& mesh = options.method == Method::kMorph ? surface.whole : surface.mesh;
  regularized.mesh = regularize(engine, surface, mesh, options, progress, &regularized.report);
  return regularized;
}

MappedStep map_once(const StatesToMap& states, const CommonFrame& frame, const MappingStart& start, KeptTurns kept,
                    const Progress& progress, StageClock& clock) {
  const bool morphs = states.options.method == Method::kMorph;
  MappedStep step;
  step.frame = frame;
  step.report.domains = frame.follows;
  // deform needs no pairs; the morph says what it misses.
  if (morphs || !states.alignment.pairing.pairs.empty()) step.paths = paths_of(states, frame, progress);
  clock.lap("atom paths");
  map_surface(states, start, step, progress, clock);
  progress.report("certificate", 0.0);
  find_matched(states, step.mapping);
  const MeshPtr& target = states.target_surface.mesh;
  step.certificate = certify(states.engine, step.mapping, target, step.mapping.matched);
  step.certificate.converged = morphs || step.report.deform.converged;
  describe(states, kept, step);
  clock.lap("certificate");
  return step;
}

Mapping map_back(const StatesToMap& states, const CommonFrame& frame, const Progress& progress) {
  std::vector<std::pair<std::string, double>> times;  // the caller's clock has one entry for the whole mapping
  StageClock clock(times);
  Alignment alignment;
  for (const auto& [s, t] : states.alignment.pairing.pairs) alignment.pairing.pairs.emplace_back(t, s);
  const auto source_of = paired_residues(states.target, states.source, alignment.pairing);
  const MeshPtr regularized = regularized_for(states.engine, states.target_surface, states.options, progress).mesh;
  const StatesToMap back{states.engine,         states.options,        states.target,
                         states.target_surface, regularized,           states.has_cavities,
                         states.source,         states.source_surface, alignment};
  MappedStep step;
  step.frame = {frame.from_target, frame.from_source, inverse(frame.domains, source_of),
                inverse(frame.followed, source_of)};
  if (states.options.method == Method::kMorph) step.paths = paths_of(back, step.frame, progress);
  map_surface(back, {}, step, progress, clock);
  find_matched(back, step.mapping);
  return std::move(step.mapping);
}

void set_unmatched_to_nan(const std::vector<bool>& is_matched, std::vector<float>& values) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!is_matched[v]) values[v] = std::numeric_limits<float>::quiet_NaN();
  }
}

MappedNormals normals_of(const StatesToMap& states, const MappedStep& step) {
  const auto normals = [&](const MeshPtr& mesh, const Surface& surface, const RigidTransform& to_common) {
    return rotated(states.engine.level_set_normals(mesh, surface.atoms, states.isovalue()), inverse(to_common));
  };
  MappedNormals of;
  of.target = normals(step.mapping.mapped, states.target_surface, step.frame.from_target);
  of.source = normals(step.mapping.source, states.source_surface, step.frame.from_source);
  return of;
}

}  // namespace espdiff
