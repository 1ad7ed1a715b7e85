// mapped_step.cpp: downloads a mapping, with its residues and its slip.
#include "compare/mapped_step.h"

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

}  // namespace

void set_unmatched_to_nan(const std::vector<bool>& is_matched, std::vector<float>& values) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!is_matched[v]) values[v] = std::numeric_limits<float>::quiet_NaN();
  }
}

void mark_turned(Engine& engine, const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                 const Surface& source_surface, const MeshPtr& mapped_source, const RigidTransform& from_source,
                 MappedSurface& s) {
  s.turned.assign(s.positions.size(), 0);
  const std::vector<TurnedAtom> atoms = turned_atoms(source, target, pairing);
  const auto has_turned = [](const TurnedAtom& atom) { return atom.turn != Turn::kNone; };
  if (std::none_of(atoms.begin(), atoms.end(), has_turned)) return;
  std::vector<std::int32_t> numbers(atoms.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  const std::vector<std::int32_t> owner =
      vertex_labels(engine, source_surface, mapped_source, source, from_source, numbers);
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (owner[v] < 0) continue;
    const TurnedAtom& atom = atoms[static_cast<std::size_t>(owner[v])];
    if (!has_turned(atom)) continue;
    const double off_A = norm(atom.carried.apply(s.source_positions[v]) - s.positions[v]);
    const bool is_far = atom.turn == Turn::kSideChain && off_A > kFarTurn_A;
    if (off_A > kLargeSlip_A) s.turned[v] = static_cast<std::uint8_t>(is_far ? Turn::kFarSideChain : atom.turn);
  }
}

void describe(Engine& engine, const Molecule& source, const Molecule& target, const Surface& source_surface,
              const Surface& target_surface, KeptTurns kept, MappedStep& step) {
  const Mapping& mapping = step.mapping;
  MappedSurface& s = step.result.surface;
  step.moved = step.frame.domains.carry(engine, mapping.source, source_surface.atoms);
  download_surface(engine, step, s);
  step.is_matched = matched_vertices(s);
  step.areas = surface_areas(s);
  set_unmatched_to_nan(step.is_matched, s.displacement);
  set_unmatched_to_nan(step.is_matched, s.path_length);
  s.residue = engine.vertex_residues(mapping.source, source_surface.atoms);
  if (!step.paths.empty()) {
    s.slip = engine.slip(mapping.source, mapping.mapped, target_surface.mesh, step.paths);
    set_unmatched_to_nan(step.is_matched, s.slip);
    step.result.certificate.slip = summarize_slip(s, matched_areas(s, step.areas));
  }
  s.target_residue = engine.vertex_residues(mapping.mapped, target_surface.atoms);
  const std::vector<std::int32_t> target_of = paired_residues(source, target, step.result.pairing);
  step.result.certificate.same_residue_area_fraction =
      same_residue_share(s, step.areas, s.residue, s.target_residue, target_of);
  mark_turned(engine, source, target, step.result.pairing, source_surface, mapping.source, step.frame.from_source, s);
  s.why = why_of_mapping(s, target_of, kept);
  step.result.residues = residue_rows(s, step.areas, source.residues.size(), false);
}

void add_normals(Engine& engine, const Surface& source_surface, const Surface& target_surface, float isovalue,
                 MappedStep& step) {
  const RigidTransform to_source = inverse(step.frame.from_source), to_target = inverse(step.frame.from_target);
  MappedSurface& s = step.result.surface;
  s.normals = rotated(engine.level_set_normals(step.mapping.mapped, target_surface.atoms, isovalue), to_target);
  s.source_normals = rotated(engine.level_set_normals(step.mapping.source, source_surface.atoms, isovalue), to_source);
}

}  // namespace espdiff
