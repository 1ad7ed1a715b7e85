// morph.cpp: surfaces that follow moving atoms: at rest, rigidly, by growth, across fading atoms, and where they tear.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::MorphOptions;
using espdiff::MorphResult;
using espdiff::MovingAtom;

namespace {

/// The input of a morph: atoms at both ends.
struct Journey {
  AtomSet source, target;
  std::vector<MovingAtom> ways;
};

Journey journey(const AtomSet& source, const AtomSet& target) {
  Journey j{source, target, {}};
  for (std::size_t i = 0; i < source.size(); ++i) {
    MovingAtom way;
    way.start = source.positions[i];
    way.end = target.positions[i];
    way.start_width = static_cast<double>(source.widths[i]);
    way.end_width = static_cast<double>(target.widths[i]);
    j.ways.push_back(way);
  }
  return j;
}

AtomSet moved_atoms(AtomSet atoms, const std::function<Vec3d(Vec3d)>& move) {
  for (Vec3d& p : atoms.positions) p = move(p);
  return atoms;
}

struct Travelled {
  Mesh source, mapped;
  std::vector<float> unmatched;
  espdiff::MorphReport report;

  std::size_t n_unmatched() const {
    return static_cast<std::size_t>(std::count_if(unmatched.begin(), unmatched.end(), [](float f) { return f != 0; }));
  }
};

espdiff::MeshPtr surface_of(Engine& engine, const espdiff::AtomsPtr& atoms, double spacing = 0.8) {
  return engine.project(engine.isosurface(engine.density(atoms, spacing), kIsovalue), atoms, kIsovalue, 0.5 * spacing);
}

Travelled travel(Engine& engine, const Journey& j, const MorphOptions& options = {}, double spacing = 0.8) {
  const auto source = upload(engine, j.source), target = upload(engine, j.target);
  const MorphResult r =
      engine.morph(surface_of(engine, source, spacing), j.ways, source, target, options, "morph", espdiff::Progress{});
  return {engine.download(r.source), engine.download(r.mapped), engine.download(r.unmatched), r.report};
}

double farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, static_cast<double>(norm(a[i] - b[i])));
  return worst;
}

}  // namespace

TEST_SUITE_BEGIN("morph");

TEST_CASE("atoms at rest leave every vertex where it is") {
  const AtomSet atoms = random_cloud(150, 3);
  for (const auto& engine : back_ends()) {
    const Travelled t = travel(*engine, journey(atoms, atoms));
    CHECK(t.report.n_vertices_added == 0);
    CHECK(t.n_unmatched() == 0);
    CHECK(farthest(t.source.positions, t.mapped.positions) < 1e-3);
  }
}

TEST_CASE("atoms that move together carry the surface rigidly") {
  const AtomSet atoms = random_cloud(150, 4);
  const Vec3d shift{5, -3, 8};
  for (const auto& engine : back_ends()) {
    const Travelled t = travel(*engine, journey(atoms, moved_atoms(atoms, [&](Vec3d p) { return p + shift; })));
    CHECK(t.n_unmatched() == 0);
    CHECK(t.report.n_vertices_added == 0);
    CHECK(t.report.steps == static_cast<int>(std::ceil(norm(shift) / MorphOptions{}.max_step_A)));
    double worst = 0;
    for (std::size_t v = 0; v < t.source.positions.size(); ++v)
      worst = std::max(
          worst, static_cast<double>(norm(t.mapped.positions[v] - t.source.positions[v] - static_cast<Vec3f>(shift))));
    CHECK(worst < 2e-3);
  }
}

TEST_CASE("a widening Gaussian moves every vertex along its radius, and long edges are split") {
  for (const auto& engine : back_ends()) {
    MorphOptions options;
    options.max_edge_A = 1.2;
    const Travelled t = travel(*engine, journey(one_gaussian({0, 0, 0}, 2), one_gaussian({0, 0, 0}, 4)), options);
    const double radius = std::sqrt(2 * std::log(2.0));  // of the isosurface of a Gaussian of width 1, isovalue 1/2
    CHECK(t.n_unmatched() == 0);
    CHECK(t.report.n_vertices_added > 0);
    CHECK(manifold_fault(t.mapped).empty());
    CHECK(manifold_fault(t.source).empty());
    CHECK(euler_characteristic(t.mapped) == 2);
    for (std::size_t v = 0; v < t.mapped.positions.size(); ++v) {
      const Vec3f from = t.source.positions[v], to = t.mapped.positions[v];
      CHECK(static_cast<double>(norm(from)) == doctest::Approx(2 * radius).epsilon(2e-4));
      CHECK(static_cast<double>(norm(to)) == doctest::Approx(4 * radius).epsilon(2e-4));
      CHECK(dot(from, to) / (norm(from) * norm(to)) > 0.999F);  // some give way to even out their triangles
    }
    double longest = 0;
    for (const auto& triangle : t.mapped.triangles)
      for (std::size_t c = 0; c < 3; ++c)
        longest = std::max(longest, static_cast<double>(norm(t.mapped.positions[triangle[c]] -
                                                             t.mapped.positions[triangle[(c + 1) % 3]])));
    CHECK(longest < 1.05 * options.max_edge_A);
  }
}

TEST_CASE("the reverse morph returns every vertex") {
  const AtomSet atoms = random_cloud(150, 5);
  const Journey out = journey(atoms, moved_atoms(atoms, [](Vec3d p) { return p + Vec3d{0, 0, 0.03 * p.x * p.x}; }));
  for (const auto& engine : back_ends()) {
    const auto source = upload(*engine, out.source), target = upload(*engine, out.target);
    MorphOptions options;
    options.max_edge_A = 5;  // the same vertices in both directions
    const MorphResult there =
        engine->morph(surface_of(*engine, source), out.ways, source, target, options, "morph", espdiff::Progress{});
    const Journey back = journey(out.target, out.source);
    const MorphResult returned =
        engine->morph(there.mapped, back.ways, target, source, options, "morph", espdiff::Progress{});
    const Mesh a = engine->download(there.source), b = engine->download(returned.mapped);
    REQUIRE(a.positions.size() == b.positions.size());
    double sum = 0;
    for (std::size_t v = 0; v < a.positions.size(); ++v)
      sum += static_cast<double>(norm(a.positions[v] - b.positions[v]));
    CHECK(sum / static_cast<double>(a.positions.size()) < 0.05);
  }
}

TEST_CASE("a continued morph: atoms at rest move no vertex, and two halves equal the whole") {
  const AtomSet atoms = random_cloud(150, 5);
  const auto bent = [&](double amount) {
    return moved_atoms(atoms, [=](Vec3d p) { return p + Vec3d{0, 0, amount * p.x * p.x}; });
  };
  const Journey first = journey(atoms, bent(0.015)), second = journey(bent(0.015), bent(0.03));
  for (const auto& engine : back_ends()) {
    const auto source = upload(*engine, atoms), middle = upload(*engine, first.target),
               target = upload(*engine, second.target);
    const espdiff::MeshPtr mesh = surface_of(*engine, source);
    const MorphResult half = engine->morph(mesh, first.ways, source, middle, {}, "morph", espdiff::Progress{});
    const MorphResult rest = engine->continue_morph(half, journey(first.target, first.target).ways, source, middle, {},
                                                    "morph", espdiff::Progress{});
    CHECK(rest.report.n_vertices_added == 0);
    CHECK(engine->download(rest.unmatched) == engine->download(half.unmatched));
    CHECK(farthest(engine->download(rest.mapped).positions, engine->download(half.mapped).positions) < 1e-3);
    CHECK(engine->download(rest.source).positions == engine->download(half.source).positions);

    const MorphResult composed =
        engine->continue_morph(half, second.ways, source, target, {}, "morph", espdiff::Progress{});
    const MorphResult whole =
        engine->morph(mesh, journey(atoms, second.target).ways, source, target, {}, "morph", espdiff::Progress{});
    const Mesh a = engine->download(composed.mapped), b = engine->download(whole.mapped);
    CHECK(manifold_fault(a).empty());
    const std::vector<float> lengths = engine->download(composed.path_length),
                             before = engine->download(half.path_length);
    double sum = 0;
    for (std::size_t v = 0; v < engine->n_vertices(mesh); ++v) {
      sum += static_cast<double>(norm(a.positions[v] - b.positions[v]));
      CHECK(lengths[v] >= before[v]);
    }
    CHECK(sum / static_cast<double>(engine->n_vertices(mesh)) < 0.03);

    MorphResult torn = half;
    torn.unmatched = engine->upload_scalars({1, 0, 0});
    CHECK_THROWS_AS(engine->continue_morph(torn, second.ways, source, target, {}, "morph", espdiff::Progress{}),
                    espdiff::GeometryError);
  }
}

TEST_CASE("surface lost by a morph stays lost when it continues") {
  AtomSet together, apart;
  for (const double x : {0.0, 4.5}) {
    together.add({x, 0, 0}, 2);
    apart.add({x > 0 ? x + 6 : x, 0, 0}, 2);
  }
  const Journey parting = journey(together, apart), meeting = journey(apart, together);
  for (const auto& engine : back_ends()) {
    const auto source = upload(*engine, together), target = upload(*engine, apart);
    const MorphResult parted =
        engine->morph(surface_of(*engine, source), parting.ways, source, target, {}, "morph", espdiff::Progress{});
    const MorphResult met =
        engine->continue_morph(parted, meeting.ways, source, source, {}, "morph", espdiff::Progress{});
    const auto unmatched_area = [&](const MorphResult& r) {
      return 1 - engine->area(engine->without(r.source, r.unmatched)) / engine->area(r.source);
    };
    CHECK(unmatched_area(parted) > 0.02);
    CHECK(unmatched_area(met) >= unmatched_area(parted) - 1e-6);
  }
}

TEST_CASE("an atom that appears grows at the start of its path, one that vanishes shrinks at its end") {
  AtomSet bare;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) bare.add({2.0 * x, 2.0 * y, 2.0 * z}, 1.6);
  AtomSet with = bare;
  with.add({6.5, 0, 0}, 1.6);
  Journey appears = journey(bare, bare), vanishes = appears;
  appears.target = vanishes.source = with;
  MovingAtom way;
  way.start = {4, 0, 0};
  way.end = {6.5, 0, 0};
  way.start_width = way.end_width = 1.6;
  way.at_start = false;
  appears.ways.push_back(way);
  std::swap(way.start, way.end);
  std::swap(way.at_start, way.at_end);
  vanishes.ways.push_back(way);
  for (const auto& engine : back_ends()) {
    for (const Journey* j : {&appears, &vanishes}) {
      const Travelled t = travel(*engine, *j);
      CHECK(t.n_unmatched() == 0);
      const auto target = upload(*engine, j->target);
      for (const float density : engine->density_at(target, t.mapped.positions))
        CHECK(std::fabs(density - 0.5F) < 1e-3F);
      const auto mapped = engine->upload_mesh(t.mapped);
      CHECK(engine->distances(surface_of(*engine, target), mapped, 1).max < 0.3);
    }
  }
}

TEST_CASE("parts that move at different speeds keep their shapes") {
  // Most atoms are slow, so that their vertices keep their flow for several steps.
  const AtomSet part = random_cloud(300, 14), small = random_cloud(60, 15);
  AtomSet before, after;
  const Vec3d slow{0.6, -0.3, 0.5}, start{-30, 30, 0}, path{60, 0, 0};
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    before.add(part.positions[i], part.widths[i]);
    after.add(part.positions[i] + slow, part.widths[i]);
  }
  for (std::size_t i = 0; i < small.positions.size(); ++i) {
    before.add(small.positions[i] + start, small.widths[i]);
    after.add(small.positions[i] + start + path, small.widths[i]);
  }
  for (const auto& engine : back_ends()) {
    const Travelled t = travel(*engine, journey(before, after));
    CHECK(t.report.steps > 120);
    CHECK(t.n_unmatched() == 0);
    double worst_slow = 0, worst_fast = 0;
    for (std::size_t v = 0; v < t.source.positions.size(); ++v) {
      const Vec3d p = static_cast<Vec3d>(t.source.positions[v]), q = static_cast<Vec3d>(t.mapped.positions[v]);
      const bool fast = p[1] > 17;
      const double off = norm(q - (fast ? p + path : p + slow));
      (fast ? worst_fast : worst_slow) = std::max(fast ? worst_fast : worst_slow, off);
    }
    CHECK(worst_fast < 0.05);
    CHECK(worst_slow < 0.05);
  }
}

TEST_CASE("two separating balls: the neck is unmatched, the rest lies on the target") {
  AtomSet together, apart;
  for (const double x : {0.0, 4.5}) {
    together.add({x, 0, 0}, 2);
    apart.add({x > 0 ? x + 6 : x, 0, 0}, 2);
  }
  for (const auto& engine : back_ends()) {
    const Travelled t = travel(*engine, journey(together, apart));
    CHECK(t.n_unmatched() > 0);
    CHECK(t.report.n_vertices_unmatched > 0);
    REQUIRE(t.unmatched.size() == t.mapped.triangles.size());
    const std::vector<float> density = engine->density_at(upload(*engine, apart), t.mapped.positions);
    for (std::size_t k = 0; k < t.unmatched.size(); ++k) {
      if (t.unmatched[k] != 0) continue;
      for (const std::uint32_t v : t.mapped.triangles[k]) CHECK(std::fabs(density[v] - 0.5F) < 0.01F);
    }
  }
}

TEST_CASE("the same bits at any number of threads") {
  const AtomSet atoms = random_cloud(150, 6);
  const Journey j = journey(atoms, moved_atoms(atoms, [](Vec3d p) {
                              return p + Vec3d{0.3 * p.y, 0, 0.05 * p.x * p.x};
                            }));
  std::uint64_t first = 0;
  for (const int n_threads : {1, 2, 3}) {
    const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
    const Travelled t = travel(*engine, j);
    const std::uint64_t hash =
        Hash().add(t.source.positions).add(t.mapped.positions).add(t.mapped.triangles).add(t.unmatched).value();
    if (n_threads == 1) first = hash;
    CHECK(hash == first);
  }
}

TEST_CASE("wrong options and a cancellation") {
  const AtomSet atoms = one_gaussian({0, 0, 0}, 2);
  const Journey j = journey(atoms, moved_atoms(atoms, [](Vec3d p) { return p + Vec3d{9, 0, 0}; }));
  for (const auto& engine : back_ends()) {
    const auto with = [&](double max_step, double max_edge, double max_stretch) {
      MorphOptions options;
      options.max_step_A = max_step;
      options.max_edge_A = max_edge;
      options.max_stretch = max_stretch;
      travel(*engine, j, options);
    };
    CHECK_THROWS_WITH_AS(with(0, 1, 2), "the morph's largest step, 0 A, is not positive; 0.35 is usual",
                         espdiff::InputError);
    CHECK_THROWS_WITH_AS(with(1, -1, 2), "the morph's longest edge, -1 A, is not positive", espdiff::InputError);
    CHECK_THROWS_WITH_AS(with(1, 1, 1), "the morph's largest stretch, 1, is not above 1; 20 is usual",
                         espdiff::InputError);
    // More steps than an int holds were once 24 or 8 of them.
    CHECK_THROWS_WITH_AS(with(1e-12, 1, 2),
                         "an atom moves 9 A from source to target, which takes 9e+12 steps of 1e-12 A; 100000 is the "
                         "limit; check that both structures show one molecule and no atom is far off, or give a larger "
                         "max-step",
                         espdiff::InputError);
    // The edges are counted before they are split: 24 GB of vertices, and more than a day.
    const std::string too_fine = message_of([&] { with(0.35, 1e-4, 20); });
    CHECK(too_fine.find("edges split to 0.0001 A, makes about ") != std::string::npos);
    CHECK(message_of([&] { with(0.001, 0.004, 20); }).find(" A, makes about ") != std::string::npos);
    Journey far = j;
    far.ways[0].end = far.ways[0].end + Vec3d{1e10, 0, 0};
    CHECK(message_of([&] { travel(*engine, far); }).find("an atom moves 1e+10 A from source to target") == 0);
    espdiff::Progress cancelled;
    cancelled.request_cancel();
    const auto source = upload(*engine, j.source), target = upload(*engine, j.target);
    const auto mesh = surface_of(*engine, source);
    CHECK_THROWS_AS(engine->morph(mesh, j.ways, source, target, {}, "morph", cancelled), espdiff::Cancelled);
  }
}

TEST_SUITE_END();
