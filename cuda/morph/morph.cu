// morph.cu: the order of the morph's steps: flow with the atoms, back onto the level set, cut out, even out, divide.
#include "cuda/morph/morph.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/error.h"
#include "base/progress.h"
#include "cuda/device/spatial_order.h"
#include "cuda/device/unwrap.h"
#include "cuda/morph/moving_surface.h"
#include "cuda/surface/project.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Atoms that fade, and widths that change, move the surface as well: it then takes this many steps at least.
constexpr int kStepsOfFading = 24;
/// The least: flow and level set are followed to second order only.
constexpr int kLeastSteps = 8;
/// Rounds of evening out at the end, where nothing moves any more.
constexpr int kLastRounds = 4;
/// How far the last projections may move a vertex: the steps leave it nearer than that.
constexpr float kLastShift_A = 0.3F;

void check_options(const MorphOptions& o) {
  if (!(o.max_step_A > 0))
    throw InputError("the morph's largest step, " + std::to_string(o.max_step_A) +
                     " A, is not positive; 0.35 is usual");
  if (!(o.max_edge_A > 0))
    throw InputError("the morph's longest edge, " + std::to_string(o.max_edge_A) + " A, is not positive");
  if (!(o.max_stretch > 1))
    throw InputError("the morph's largest stretch, " + std::to_string(o.max_stretch) + ", is not above 1; 20 is usual");
}

/// More would take days. An atom that far off is a mistake in the input.
constexpr int kMostSteps = 100000;

int steps_for(const std::vector<MovingAtom>& atoms, const MorphOptions& options) {
  double farthest = 0;
  bool fades = false;
  for (const MovingAtom& a : atoms) {
    // On a screw the speed is the same everywhere but for the atom's own way.
    farthest = std::max({farthest, norm(a.velocity_at(0)), norm(a.velocity_at(1))});
    fades = fades || !a.at_start || !a.at_end || std::abs(a.start_width - a.end_width) > 1e-3;
  }
  const double n_steps = std::ceil(farthest / options.max_step_A);
  if (!(n_steps <= kMostSteps)) {
    char text[240];
    std::snprintf(text, sizeof text,
                  "an atom moves %.6g A from source to target, which takes %.6g steps of %.6g A; %d is the limit; check "
                  "that both structures are of one molecule and no atom is far off, or allow larger steps",
                  farthest, n_steps, options.max_step_A, kMostSteps);
    throw InputError(text);
  }
  return std::max(fades ? kStepsOfFading : kLeastSteps, static_cast<int>(n_steps));
}

std::shared_ptr<Scalars> as_scalars(const Buffer<std::uint8_t>& flags) {
  auto scalars = std::make_shared<Scalars>();
  scalars->values.resize(flags.size());
  const std::uint8_t* const flag = raw(flags);
  float* const value = raw(scalars->values);
  for_each_index(flags.size(), [=] ESPDIFF_HD(std::size_t i) { value[i] = static_cast<float>(flag[i]); });
  return scalars;
}

/// With the last projection.
std::shared_ptr<Scalars> path_lengths(const MovingSurface& surface, const SurfaceMesh& arrived) {
  auto lengths = std::make_shared<Scalars>();
  lengths->values.resize(surface.n_vertices());
  const Vec4f* const before = raw(surface.x);
  const Vec4f* const after = raw(arrived.positions);
  float* const length = raw(lengths->values);
  for_each_index(surface.n_vertices(),
                 [=] ESPDIFF_HD(std::size_t v) { length[v] = before[v].w + norm(after[v].xyz() - before[v].xyz()); });
  return lengths;
}

/// A surface that an earlier morph has brought so far. Its vertices that are lost are those that have no triangle left.
MovingSurface take_up(const MorphResult& so_far) {
  const auto& source = unwrap<SurfaceMesh>(so_far.source);
  const auto& mapped = unwrap<SurfaceMesh>(so_far.mapped);
  const auto& cut = unwrap<Scalars>(so_far.unmatched);
  const auto& path_length = unwrap<Scalars>(so_far.path_length);
  if (mapped.n_vertices() != source.n_vertices() || mapped.n_triangles() != source.n_triangles() ||
      cut.values.size() != source.n_triangles() || path_length.values.size() != source.n_vertices())
    throw GeometryError("a morph of " + std::to_string(source.n_vertices()) +
                        " vertices cannot go on: its meshes, what it lost and its path lengths differ in size");
  MovingSurface surface = set_out(source);
  surface.x = mapped.positions;
  const MovingSurfaceView s = view_of(surface);
  const float* const length = raw(path_length.values);
  const float* const unmatched = raw(cut.values);
  for_each_index(s.topology.n_triangles, [=] ESPDIFF_HD(std::size_t t) { s.cut[t] = unmatched[t] != 0 ? 1 : 0; });
  for_each_index(s.topology.n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    s.x[v].w = length[v];
    bool any = false;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n)
      any = any || s.cut[s.topology.incident[n]] == 0;
    s.unmatched[v] = any ? 0 : 1;
  });
  surface.order = spatial_order(surface.x);
  return surface;
}

/// Both ends on their isosurfaces. Vertices of the given mesh keep the places that they came with; those added lie in
/// the middles of edges, beside the surface.
MorphResult arrive(const MovingSurface& surface, const SurfaceMesh& mesh, const AtomCells& source_atoms,
                   const AtomCells& target_atoms, float isovalue) {
  SurfaceMesh source, mapped;
  source.topology = mapped.topology = surface.topology;
  source.positions = surface.source;
  mapped.positions = surface.x;
  auto on_source = project(source, source_atoms, isovalue, kLastShift_A);
  copy_on_device(raw(on_source->positions), raw(mesh.positions), mesh.n_vertices() * sizeof(Vec4f));
  MorphResult result;
  result.source = on_source;
  const auto on_target = project(mapped, target_atoms, isovalue, kLastShift_A);
  result.mapped = on_target;
  result.unmatched = as_scalars(surface.cut);
  result.path_length = path_lengths(surface, *on_target);
  const std::uint8_t* const unmatched = raw(surface.unmatched);
  result.report.n_vertices_unmatched =
      sum_over<std::size_t>(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { return std::size_t{unmatched[v]}; });
  return result;
}

/// All the way of the atoms. `mesh` is where the surface comes from.
MorphResult travel(MovingSurface surface, const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms,
                   const AtomCells& source_atoms, const AtomCells& target_atoms, const MorphOptions& options,
                   const std::string& stage, const Progress& progress) {
  check_options(options);
  const float isovalue = static_cast<float>(options.isovalue);
  const float max_edge = static_cast<float>(options.max_edge_A), max_stretch = static_cast<float>(options.max_stretch);
  const int n_steps = steps_for(atoms, options);
  std::size_t n_added = 0;
  return_to_level_set(surface, atoms_at(atoms, 0.0), isovalue);
  surface.previous = surface.flow;
  for (int step = 1; step <= n_steps; ++step) {
    progress.report(stage, static_cast<double>(step - 1) / n_steps);
    advance(surface, 1.0F / static_cast<float>(n_steps));
    return_to_level_set(surface, atoms_at(atoms, static_cast<double>(step) / n_steps), isovalue);
    remove_torn_triangles(surface);
    smooth_tangentially(surface);
    n_added += split_long_edges(surface, max_edge, max_stretch);
  }
  // What the last step added or evened out lies beside the level set.
  const MovingAtoms arrived = atoms_at(atoms, 1.0);
  for (int round = 0; round < kLastRounds; ++round) {
    return_to_level_set(surface, arrived, isovalue);
    remove_torn_triangles(surface);
    if (round + 1 < kLastRounds) smooth_tangentially(surface);
  }
  progress.report(stage, 1.0);
  MorphResult result = arrive(surface, mesh, source_atoms, target_atoms, isovalue);
  result.report.steps = n_steps;
  result.report.n_vertices_added = n_added;
  return result;
}

}  // namespace

MovingSurface set_out(const SurfaceMesh& mesh) {
  MovingSurface surface;
  surface.topology = mesh.topology;
  surface.source = mesh.positions;
  surface.x = mesh.positions;
  Vec4f* const x = raw(surface.x);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { x[v].w = 0.0F; });
  surface.flow.assign(mesh.n_vertices(), Vec4f{});
  surface.previous.assign(mesh.n_vertices(), Vec4f{});
  surface.gradient.assign(mesh.n_vertices(), Vec4f{});
  surface.unmatched.assign(mesh.n_vertices(), 0);
  surface.cut.assign(mesh.n_triangles(), 0);
  surface.order = spatial_order(surface.x);
  return surface;
}

MorphResult morph(const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms, const AtomCells& source_atoms,
                  const AtomCells& target_atoms, const MorphOptions& options, const std::string& stage,
                  const Progress& progress) {
  return travel(set_out(mesh), mesh, atoms, source_atoms, target_atoms, options, stage, progress);
}

MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                           const AtomCells& source_atoms, const AtomCells& target_atoms, const MorphOptions& options,
                           const std::string& stage, const Progress& progress) {
  return travel(take_up(so_far), unwrap<SurfaceMesh>(so_far.source), atoms, source_atoms, target_atoms,
                options, stage, progress);
}

}  // namespace espdiff::ESPDIFF_BACKEND
