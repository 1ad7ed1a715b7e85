// morph.cu: the steps of the morph: flow with the atoms, back onto the level set, cut out what broke, even out, divide.
#include "morph.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "adjacency.h"
#include "base/error.h"
#include "moving_atoms.h"
#include "project.h"
#include "split_edges.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

double knob(const char* name, double fallback) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : fallback;
}

constexpr int kMaxNewtonSteps = 4;
/// Off the isovalue by less than this, the next Newton step is the last.
constexpr float kLastStepExcess = 0.03F;
/// Off by more than this after the last one, a vertex is lost.
constexpr float kLostExcess = 0.1F;
/// A vertex that Newton's method takes farther than this in one step has left its sheet of the surface.
constexpr float kMaxShift_A = 0.6F;
constexpr float kMinSlope = 0.02F;  // 1/Angstrom

/// The surface on its way.
struct Travelling {
  std::shared_ptr<const Topology> topology;
  Buffer<Vec4f> source;    // [vertex] where it comes from
  Buffer<Vec4f> x;         // [vertex] where it is
  Buffer<Vec4f> flow;      // [vertex] the atoms' velocity; w: what the level set adds along the gradient, A per time
  Buffer<Vec4f> previous;  // [vertex] flow of the step before
  Buffer<Vec4f> gradient;  // [vertex] w: density
  Buffer<std::uint8_t> lost;  // [vertex]
  Buffer<std::uint8_t> cut;   // [triangle]

  TopologyView view() const {
    return {x.size(),        topology->triangles.size(), raw(topology->triangles), raw(topology->first),
            raw(topology->neighbour), raw(topology->incident)};
  }
};

struct View {
  TopologyView topology;
  Vec4f* source;
  Vec4f* x;
  Vec4f* flow;
  Vec4f* previous;
  Vec4f* gradient;
  std::uint8_t* lost;
  std::uint8_t* cut;
};

View view_of(Travelling& s) {
  return {s.view(), raw(s.source), raw(s.x), raw(s.flow), raw(s.previous), raw(s.gradient), raw(s.lost), raw(s.cut)};
}

/// Moves every vertex with the flow: second order in time for the atoms' part (Adams and Bashforth).
void advance(Travelling& state, float dt) {
  const View s = view_of(state);
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec4f flow = s.flow[v], before = s.previous[v];
    Vec3f move = dt * (1.5F * flow.xyz() - 0.5F * before.xyz());
    const Vec3f gradient = s.gradient[v].xyz();
    const float slope = norm(gradient);
    if (s.lost[v] == 0 && slope > kMinSlope) {
      const float along = fminf(fmaxf(dt * flow.w, -0.5F), 0.5F);
      move += (along / slope) * gradient;
    }
    s.x[v] = make_vec4(s.x[v].xyz() + move, 0.0F);
    s.previous[v] = flow;
  });
}

/// Back onto the level set; what the flow is there; which vertices cannot be brought back.
void correct(Travelling& state, const MovingAtoms& atoms, float isovalue) {
  const View s = view_of(state);
  const MovingAtomsView view = atoms.view();
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec3f start = s.x[v].xyz();
    Vec3f p = start;
    FlowSample sample = flow_at(view, p);
    bool arrived = false, lost = s.lost[v] != 0;
    for (int step = 0; step < kMaxNewtonSteps && !lost && !arrived; ++step) {
      if (step > 0) sample = flow_at(view, p);
      const float excess = sample.density - isovalue;
      const float square = dot(sample.gradient, sample.gradient);
      if (!(square > kMinSlope * kMinSlope)) {
        lost = true;
        break;
      }
      Vec3f shift = (-excess / square) * sample.gradient;
      const float length = norm(shift);
      if (length > 0.5F * kMaxShift_A) shift = (0.5F * kMaxShift_A / length) * shift;
      p += shift;
      arrived = fabsf(excess) < kLastStepExcess;
      if (norm(p - start) > kMaxShift_A) lost = true;
    }
    if (!arrived && !lost) {
      sample = flow_at(view, p);
      lost = fabsf(sample.density - isovalue) > kLostExcess;
    }
    if (lost) p = start;
    s.lost[v] = lost ? 1 : 0;
    const float slope = fmaxf(norm(sample.gradient), kMinSlope);
    const float rate = sample.rate + dot(sample.gradient, sample.velocity);
    s.x[v] = make_vec4(p, 0.0F);
    s.gradient[v] = make_vec4(sample.gradient, sample.density);
    s.flow[v] = make_vec4(sample.velocity, -rate / slope);
  });
}

/// Cuts triangles that lost a corner or turned over, then gives up the vertices without a triangle.
void cut_out(Travelling& state, bool vertices_of_flipped) {
  const View s = view_of(state);
  Buffer<std::uint8_t> flipped_flags(state.cut.size());
  std::uint8_t* const flipped = raw(flipped_flags);
  for_each_index(state.cut.size(), [=] ESPDIFF_HD(std::size_t t) {
    const Corners c = s.topology.triangles[t];
    const Vec3f uphill = s.gradient[c.v[0]].xyz() + s.gradient[c.v[1]].xyz() + s.gradient[c.v[2]].xyz();
    flipped[t] = dot(twice_area_vector(s.x, c), uphill) >= 0 ? 1 : 0;
  });
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    if (s.lost[v] != 0) return;
    Vec3f normal{};
    bool any = false, bad = false;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
      const std::uint32_t t = s.topology.incident[n];
      if (s.cut[t] != 0) continue;
      any = true;
      if (flipped[t] != 0) bad = true;
      normal += twice_area_vector(s.x, s.topology.triangles[t]);
    }
    if (!any || (vertices_of_flipped && bad) || dot(normal, s.gradient[v].xyz()) > 0) s.lost[v] = 1;
  });
  for_each_index(state.cut.size(), [=] ESPDIFF_HD(std::size_t t) {
    if (s.cut[t] != 0) return;
    const Corners c = s.topology.triangles[t];
    const bool lost = s.lost[c.v[0]] != 0 || s.lost[c.v[1]] != 0 || s.lost[c.v[2]] != 0;
    if (lost || flipped[t] != 0) s.cut[t] = 1;
  });
}

/// 1 for an equilateral triangle, 0 for one without area.
ESPDIFF_INLINE float shape_quality(const Vec4f* x, const Corners& c) {
  const Vec3f ab = x[c.v[1]].xyz() - x[c.v[0]].xyz(), bc = x[c.v[2]].xyz() - x[c.v[1]].xyz(),
              ca = x[c.v[0]].xyz() - x[c.v[2]].xyz();
  const float squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
  return squares > 0 ? 3.4641016F * norm(cross(ab, ca)) / squares : 0.0F;
}

/// Least altitude of a triangle.
ESPDIFF_INLINE float least_altitude(const Vec4f* x, const Corners& c) {
  const Vec3f ab = x[c.v[1]].xyz() - x[c.v[0]].xyz(), bc = x[c.v[2]].xyz() - x[c.v[1]].xyz(),
              ca = x[c.v[0]].xyz() - x[c.v[2]].xyz();
  const float longest = sqrtf(fmaxf(dot(ab, ab), fmaxf(dot(bc, bc), dot(ca, ca))));
  return longest > 0 ? norm(cross(ab, ca)) / longest : 0.0F;
}

/// Moves vertices whose triangles have suffered toward the middle of their ring, along the surface.
void even_out(Travelling& state, Buffer<Vec4f>& scratch, float keep) {
  scratch.resize(state.x.size());
  const View s = view_of(state);
  Vec4f* const to = raw(scratch);
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    to[v] = s.x[v];
    if (s.lost[v] != 0) return;
    float now = 1.0F, before = 1.0F, altitude = 1e30F;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
      const std::uint32_t t = s.topology.incident[n];
      if (s.cut[t] != 0) return;  // at a border
      now = fminf(now, shape_quality(s.x, s.topology.triangles[t]));
      before = fminf(before, shape_quality(s.source, s.topology.triangles[t]));
      altitude = fminf(altitude, least_altitude(s.x, s.topology.triangles[t]));
    }
    const float need = 1.0F - now / (keep * before);
    if (!(need > 0)) return;
    Vec3f move = (0.5F * fminf(1.0F, 2.0F * need)) * umbrella(s.topology, s.x, v).xyz();
    const Vec3f gradient = s.gradient[v].xyz();
    move = move - (dot(move, gradient) / dot(gradient, gradient)) * gradient;
    const float length = norm(move), most = altitude / 3.0F;
    if (length > most) move = (most / length) * move;
    to[v] = make_vec4(s.x[v].xyz() + move, 0.0F);
  });
  state.x.swap(scratch);
}

template <typename T>
Buffer<T> with_middles(const Buffer<T>& values, const EdgeSplit& split) {
  const std::size_t n = values.size();
  Buffer<T> result = values;
  result.resize(n + split.ends.size());
  T* const out = raw(result);
  const EdgeSplit::Ends* const ends = raw(split.ends);
  for_each_index(split.ends.size(),
                 [=] ESPDIFF_HD(std::size_t k) { out[n + k] = 0.5F * (out[ends[k].a] + out[ends[k].b]); });
  return result;
}

/// Halves the edges that have grown too long, and cuts at those that have grown beyond all measure.
std::size_t divide_long(Travelling& state, const MorphOptions& options) {
  const View s = view_of(state);
  Buffer<std::uint32_t> marks(3 * state.cut.size());
  std::uint32_t* const mark = raw(marks);
  const float longest = static_cast<float>(options.max_edge_A), stretch = static_cast<float>(options.max_stretch);
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t p = s.topology.first[v]; p < s.topology.first[v + 1]; ++p) {
      mark[p] = 0;
      const std::uint32_t other = s.topology.neighbour[p];
      if (v > other || s.lost[v] != 0 || s.lost[other] != 0) continue;
      const Vec3f edge = s.x[v].xyz() - s.x[other].xyz();
      const float length = norm(edge);
      if (length <= longest) continue;
      // An edge whose triangles are both cut is no longer part of the surface.
      bool live = false;
      for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
        const std::uint32_t t = s.topology.incident[n];
        const Corners c = s.topology.triangles[t];
        live = live || (s.cut[t] == 0 && (c.v[0] == other || c.v[1] == other || c.v[2] == other));
      }
      if (!live) continue;
      const float from = norm(s.source[v].xyz() - s.source[other].xyz());
      mark[p] = length > stretch * from ? 2 : 1;
    }
  });
  // Cut at what is stretched beyond all measure.
  for_each_index(state.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t p = s.topology.first[v]; p < s.topology.first[v + 1]; ++p) {
      if (mark[p] != 2) continue;
      mark[p] = 0;
      s.lost[v] = 1;
    }
  });
  const std::size_t n_marked =
      sum_over<std::size_t>(marks.size(), [=] ESPDIFF_HD(std::size_t p) { return std::size_t{mark[p]}; });
  if (n_marked == 0) return 0;
  EdgeSplit split = split_edges(*state.topology, marks, state.x);
  Buffer<std::uint8_t> cut(split.parent.size());
  const std::uint8_t* const old_cut = raw(state.cut);
  std::uint8_t* const new_cut = raw(cut);
  const std::uint32_t* const parent = raw(split.parent);
  for_each_index(cut.size(), [=] ESPDIFF_HD(std::size_t t) { new_cut[t] = old_cut[parent[t]]; });
  state.source = with_middles(state.source, split);
  state.x = with_middles(state.x, split);
  state.flow = with_middles(state.flow, split);
  state.previous = with_middles(state.previous, split);
  state.gradient = with_middles(state.gradient, split);
  state.lost.resize(state.x.size(), 0);
  state.cut.swap(cut);
  state.topology = split.topology;
  return split.ends.size();
}

int steps_for(const std::vector<MovingAtom>& atoms, const MorphOptions& options) {
  double farthest = 0;
  bool changes = false;
  for (const MovingAtom& a : atoms) {
    farthest = std::max(farthest, norm(a.end - a.start));
    changes = changes || !a.at_start || !a.at_end || std::abs(a.start_width - a.end_width) > 1e-3;
  }
  const int steps = static_cast<int>(std::ceil(farthest / options.max_step_A));
  return std::max(changes ? 4 * options.min_steps : options.min_steps, steps);
}

}  // namespace

MorphResult morph(const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms, const AtomCells& source_atoms,
                  const AtomCells& target_atoms, const MorphOptions& given, const std::string& stage,
                  const Progress& progress) {
  MorphOptions options = given;
  options.max_step_A = knob("M_STEP", options.max_step_A);
  options.max_edge_A = knob("M_EDGE", options.max_edge_A);
  options.max_stretch = knob("M_STRETCH", options.max_stretch);
  const bool vertices_of_flipped = knob("M_VFLIP", 0) > 0;
  const float keep = static_cast<float>(knob("M_KEEP", 0.7));
  const float isovalue = static_cast<float>(options.isovalue);
  Travelling state;
  state.topology = mesh.topology;
  state.source = mesh.positions;
  state.x = mesh.positions;
  const std::size_t n = mesh.n_vertices();
  state.flow.resize(n);
  state.previous.resize(n);
  state.gradient.resize(n);
  state.lost.assign(n, 0);
  state.cut.assign(mesh.n_triangles(), 0);
  Buffer<Vec4f> scratch;

  MorphResult result;
  const int n_steps = steps_for(atoms, options);
  const float dt = 1.0F / static_cast<float>(n_steps);
  correct(state, atoms_at(atoms, 0.0), isovalue);
  state.previous = state.flow;
  for (int step = 0; step < n_steps; ++step) {
    progress.report(stage, static_cast<double>(step) / n_steps);
    advance(state, dt);
    correct(state, atoms_at(atoms, static_cast<double>(step + 1) / n_steps), isovalue);
    cut_out(state, vertices_of_flipped);
    if (step + 1 < n_steps) even_out(state, scratch, keep);
    result.report.n_vertices_added += divide_long(state, options);
  }
  for (int polish = 0; polish < 2; ++polish) {
    correct(state, atoms_at(atoms, 1.0), isovalue);
    cut_out(state, vertices_of_flipped);
  }
  result.report.steps = n_steps;

  SurfaceMesh source, mapped;
  source.topology = mapped.topology = state.topology;
  source.positions = state.source;
  mapped.positions = state.x;
  auto projected_source = project(source, source_atoms, isovalue, 0.5F);
  thrust::copy_n(thrust::device, mesh.positions.begin(), n, projected_source->positions.begin());
  auto projected_mapped = project(mapped, target_atoms, isovalue, 0.3F);
  result.source = projected_source;
  result.mapped = projected_mapped;
  auto lost = std::make_shared<Scalars>();
  lost->values.resize(state.cut.size());
  const std::uint8_t* const cut = raw(state.cut);
  float* const flag = raw(lost->values);
  for_each_index(state.cut.size(), [=] ESPDIFF_HD(std::size_t t) { flag[t] = static_cast<float>(cut[t]); });
  result.lost = lost;
  const std::uint8_t* const gone = raw(state.lost);
  result.report.n_vertices_lost =
      sum_over<std::size_t>(state.x.size(), [=] ESPDIFF_HD(std::size_t v) { return std::size_t{gone[v]}; });
  progress.report(stage, 1.0);
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
