// morph.cu: the steps of the morph: advect with the atoms, return to the level set, remove, smooth, split.
#include "cuda/morph/morph.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/work.h"
#include "cuda/device/spatial_order.h"
#include "cuda/device/unwrap.h"
#include "cuda/morph/follow_level_set.h"
#include "cuda/morph/local_time_steps.h"
#include "cuda/morph/moving_surface.h"
#include "cuda/morph/remove_torn_triangles.h"
#include "cuda/morph/smooth_tangentially.h"
#include "cuda/morph/split_long_edges.h"
#include "cuda/surface/project.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Minimum number of steps if atoms fade or widths change, which moves the surface too.
constexpr int kStepsOfFading = 16;
/// Minimum number of steps: flow and level set are followed to second order only.
constexpr int kLeastSteps = 8;
/// Number of steps of the longest interval at which the flow of a vertex is evaluated.
constexpr std::uint32_t kLongestInterval = 8;
/// An interval is tried if at least this share of the atoms is slow enough for it: the search for the others near each
/// vertex costs more than it saves where most are fast.
constexpr double kLeastSlow = 0.75;
/// The flow of each vertex is evaluated at least so often after the start.
constexpr int kLeastEvaluations = 2;
/// Edges are split in every second step: they grow slowly, and each split numbers the whole mesh anew.
constexpr int kStepsOfSplit = 2;
/// Rounds of smoothing at the end, after the atoms have stopped.
constexpr int kLastRounds = 4;
/// Largest shift of the final projections; the steps end closer to the surface than this.
constexpr float kLastShift_A = 0.3F;

void check_options(const MorphOptions& o) {
  if (!(o.max_step_A > 0))
    throw InputError("the morph's largest step, " + formatted(o.max_step_A) + " A, is not positive; 0.35 is usual");
  if (!(o.max_edge_A > 0))
    throw InputError("the morph's longest edge, " + formatted(o.max_edge_A) + " A, is not positive");
  if (!(o.max_stretch > 1))
    throw InputError("the morph's largest stretch, " + formatted(o.max_stretch) + ", is not above 1; 20 is usual");
}

/// More would take days. An atom that far off is a mistake in the input.
constexpr int kMostSteps = 100000;

/// On a screw the speed is constant except for the atom's own path.
double farthest_path(const MovingAtom& atom) { return std::max(norm(atom.velocity_at(0)), norm(atom.velocity_at(1))); }

bool has_fading(const MovingAtom& a) {
  return !a.at_start || !a.at_end || std::abs(a.start_width - a.end_width) > 1e-3;
}

int steps_for(const std::vector<MovingAtom>& atoms, const MorphOptions& options) {
  double farthest = 0;
  bool fades = false;
  for (const MovingAtom& a : atoms) {
    farthest = std::max(farthest, farthest_path(a));
    fades = fades || has_fading(a);
  }
  const double n_steps = std::ceil(farthest / options.max_step_A);
  if (!(n_steps <= kMostSteps)) {
    const std::string text =
        formatted("an atom moves %.6g A from source to target, which takes %.6g steps of %.6g A; %d is the limit; ",
                  farthest, n_steps, options.max_step_A, kMostSteps);
    throw InputError(text +
                     Message("check that both structures show one molecule and no atom is far off, or give a "
                             "larger ") +
                     option("max-step"));
  }
  return std::max(fades ? kStepsOfFading : kLeastSteps, static_cast<int>(n_steps));
}

/// A vertex has at least as many evaluations as the morph would have steps if all moved and faded as the atoms near it.
LocalTimeSteps local_steps(const std::vector<MovingAtom>& atoms, int n_steps, const MorphOptions& options) {
  const auto max_step_A = static_cast<float>(options.max_step_A);
  std::vector<float> displacements_A;
  for (const MovingAtom& a : atoms) {
    const double as_fading = has_fading(a) ? options.max_step_A * kStepsOfFading : 0;
    displacements_A.push_back(static_cast<float>(std::max(farthest_path(a), as_fading) / n_steps));
  }
  const auto n_slow = [&](std::uint32_t interval) {
    return std::count_if(displacements_A.begin(), displacements_A.end(),
                         [&](float d) { return static_cast<float>(interval) * d <= max_step_A; });
  };
  std::uint32_t longest = kLongestInterval;
  while (longest > 1 && (static_cast<int>(longest) * kLeastEvaluations > n_steps ||
                         static_cast<double>(n_slow(longest)) < kLeastSlow * static_cast<double>(atoms.size())))
    longest /= 2;
  return {std::move(displacements_A), longest, max_step_A};
}

std::shared_ptr<Scalars> as_scalars(const Buffer<std::uint8_t>& flags) {
  auto scalars = std::make_shared<Scalars>();
  scalars->values.resize(flags.size());
  const std::uint8_t* const flag = raw(flags);
  float* const value = raw(scalars->values);
  for_each_index(flags.size(), [=] ESPDIFF_HD(std::size_t i) { value[i] = static_cast<float>(flag[i]); });
  return scalars;
}

/// Path lengths including the final projection.
std::shared_ptr<Scalars> path_lengths(const MovingSurface& surface, const SurfaceMesh& projected) {
  auto lengths = std::make_shared<Scalars>();
  lengths->values.resize(surface.n_vertices());
  const Vec4f* const before = raw(surface.x);
  const Vec4f* const after = raw(projected.positions);
  float* const length = raw(lengths->values);
  for_each_index(surface.n_vertices(),
                 [=] ESPDIFF_HD(std::size_t v) { length[v] = before[v].w + norm(after[v].xyz() - before[v].xyz()); });
  return lengths;
}

/// The surface at the end of an earlier morph. Its unmatched vertices are those without any remaining triangle.
MovingSurface resume_surface(const MorphResult& so_far) {
  const auto& source = unwrap<SurfaceMesh>(so_far.source);
  const auto& mapped = unwrap<SurfaceMesh>(so_far.mapped);
  const auto& removed = unwrap<Scalars>(so_far.unmatched);
  const auto& path_length = unwrap<Scalars>(so_far.path_length);
  if (mapped.n_vertices() != source.n_vertices() || mapped.n_triangles() != source.n_triangles() ||
      removed.values.size() != source.n_triangles() || path_length.values.size() != source.n_vertices())
    throw GeometryError("a morph of " + std::to_string(source.n_vertices()) +
                        " vertices cannot continue: its meshes, removed triangles and path lengths differ in size");
  MovingSurface surface = start_surface(source);
  surface.x = mapped.positions;
  const MovingSurfaceView s = view_of(surface);
  const float* const length = raw(path_length.values);
  const float* const unmatched = raw(removed.values);
  for_each_index(s.topology.n_triangles, [=] ESPDIFF_HD(std::size_t t) { s.removed[t] = unmatched[t] != 0 ? 1 : 0; });
  for_each_index(s.topology.n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    s.x[v].w = length[v];
    bool any = false;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n)
      any = any || s.removed[s.topology.incident[n]] == 0;
    s.unmatched[v] = any ? 0 : 1;
  });
  surface.order = spatial_order(surface.x);
  return surface;
}

/// Projects both ends onto their isosurfaces. Vertices of the given mesh keep their positions; added vertices are
/// midpoints of edges and lie beside the surface.
MorphResult project_ends(const MovingSurface& surface, const SurfaceMesh& mesh, const AtomCells& source_atoms,
                         const AtomCells& target_atoms, float isovalue) {
  SurfaceMesh source, mapped;
  source.topology = mapped.topology = surface.topology;
  source.positions = surface.source;
  mapped.positions = surface.x;
  auto on_source = project(source, source_atoms, isovalue, kLastShift_A, mesh.n_vertices());
  copy_on_device(raw(on_source->positions), raw(mesh.positions), mesh.n_vertices() * sizeof(Vec4f));
  MorphResult result;
  result.source = on_source;
  const auto on_target = project(mapped, target_atoms, isovalue, kLastShift_A);
  result.mapped = on_target;
  result.unmatched = as_scalars(surface.removed);
  result.path_length = path_lengths(surface, *on_target);
  const std::uint8_t* const unmatched = raw(surface.unmatched);
  result.report.n_vertices_unmatched =
      sum_over<std::size_t>(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { return std::size_t{unmatched[v]}; });
  return result;
}

/// Asks for memory and time before edges are split again and again, by the mean square of the edges as they are.
void check_work(MovingSurface& surface, const MorphOptions& options, int n_steps) {
  const MovingSurfaceView s = view_of(surface);
  const std::size_t n = surface.n_vertices();
  const double squares = sum_over<double>(n, [=] ESPDIFF_HD(std::size_t v) {
    double sum = 0;
    for (std::uint32_t p = s.topology.first[v]; p < s.topology.first[v + 1]; ++p) {
      const Vec3f edge = s.x[v].xyz() - s.x[s.topology.neighbour[p]].xyz();
      sum += static_cast<double>(dot(edge, edge));
    }
    return sum;
  });
  const double square = squares / (3.0 * static_cast<double>(s.topology.n_triangles));
  // A split quarters the triangles, so that edges end between the limit and half of it.
  const double n_split = static_cast<double>(n) * std::max(1.0, 2 * square / (options.max_edge_A * options.max_edge_A));
  const std::string what = "a morph of " + formatted(static_cast<double>(n)) + " vertices in " +
                           std::to_string(n_steps) + " steps, edges split to " + formatted(options.max_edge_A) +
                           " A, makes about " + formatted(n_split) + " vertices";
  constexpr double kBytesOfVertex = 400, kStepsOfVertex = 300;  // atoms near it
  require_memory(kBytesOfVertex * n_split, what);
  require_work(kStepsOfVertex * n_split * n_steps, what,
               "give a larger " + option("max-edge") + " or " + option("max-step"));
}

/// Runs all steps. `mesh` is the initial surface on the source.
MorphResult run_steps(MovingSurface surface, const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms,
                      const AtomCells& source_atoms, const AtomCells& target_atoms, const MorphOptions& options,
                      const std::string& stage, const Progress& progress) {
  check_options(options);
  const float isovalue = static_cast<float>(options.isovalue);
  const float max_edge = static_cast<float>(options.max_edge_A), max_stretch = static_cast<float>(options.max_stretch);
  const int n_steps = steps_for(atoms, options);
  check_work(surface, options, n_steps);
  std::size_t n_added = 0;
  MovingAtoms now = atoms_at(atoms, 0.0);
  return_to_level_set(surface, now, isovalue);
  surface.previous = surface.flow;
  const LocalTimeSteps local = local_steps(atoms, n_steps, options);
  const float dt = 1.0F / static_cast<float>(n_steps);
  begin_intervals(surface, local, now, 0, dt);
  now = atoms_at(atoms, 1.0 / n_steps);
  Buffer<Vec4f> settled;
  for (int step = 1; step <= n_steps; ++step) {
    progress.report(stage, static_cast<double>(step - 1) / n_steps);
    const auto number = static_cast<std::uint32_t>(step);
    advance(surface, number, dt);
    end_intervals(surface, number, step == n_steps);
    return_to_level_set(surface, now, isovalue);
    if (step == n_steps) settled = surface.x;
    begin_intervals(surface, local, now, number, dt);
    remove_torn_triangles(surface);
    smooth_tangentially(surface);
    std::optional<LongEdges> edges;
    if (step % kStepsOfSplit == 0 || step == n_steps) edges = find_long_edges(surface, max_edge, max_stretch);
    // The host computes the next atoms while a GPU still works on this step.
    if (step < n_steps) now = atoms_at(atoms, static_cast<double>(step + 1) / n_steps);
    if (edges) n_added += split_long_edges(surface, *edges);
  }
  // The vertices added or moved in the last step lie beside the level set.
  for (int round = 0; round < kLastRounds; ++round) {
    wait_where_settled(surface, settled);
    return_to_level_set(surface, now, isovalue);
    settled = surface.x;
    surface.waits.assign(surface.n_vertices(), 0);
    remove_torn_triangles(surface);
    if (round + 1 < kLastRounds) smooth_tangentially(surface);
  }
  progress.report(stage, 1.0);
  MorphResult result = project_ends(surface, mesh, source_atoms, target_atoms, isovalue);
  result.report.steps = n_steps;
  result.report.n_vertices_added = n_added;
  return result;
}

}  // namespace

MovingSurface start_surface(const SurfaceMesh& mesh) {
  MovingSurface surface;
  surface.topology = mesh.topology;
  surface.source = mesh.positions;
  surface.x = mesh.positions;
  Vec4f* const x = raw(surface.x);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { x[v].w = 0.0F; });
  surface.flow.assign(mesh.n_vertices(), Vec4f{});
  surface.previous.assign(mesh.n_vertices(), Vec4f{});
  surface.gradient.assign(mesh.n_vertices(), Vec4f{});
  surface.clock.assign(mesh.n_vertices(), VertexClock{0, 1, 1});
  surface.waits.assign(mesh.n_vertices(), 0);
  surface.unmatched.assign(mesh.n_vertices(), 0);
  surface.removed.assign(mesh.n_triangles(), 0);
  surface.order = spatial_order(surface.x);
  return surface;
}

MorphResult morph(const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms, const AtomCells& source_atoms,
                  const AtomCells& target_atoms, const MorphOptions& options, const std::string& stage,
                  const Progress& progress) {
  return run_steps(start_surface(mesh), mesh, atoms, source_atoms, target_atoms, options, stage, progress);
}

MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                           const AtomCells& source_atoms, const AtomCells& target_atoms, const MorphOptions& options,
                           const std::string& stage, const Progress& progress) {
  return run_steps(resume_surface(so_far), unwrap<SurfaceMesh>(so_far.source), atoms, source_atoms, target_atoms,
                   options, stage, progress);
}

}  // namespace espdiff::ESPDIFF_BACKEND
