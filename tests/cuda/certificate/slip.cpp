// slip.cpp: slip where it is known: on surfaces that stay, rotate, or follow the wrong atoms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/morph_stage.h"

using namespace espdiff_test;
using espdiff::MovingAtom;

namespace {

MovingAtom atom(Vec3d start, Vec3d end, std::int32_t pair) {
  MovingAtom path;
  path.start = start;
  path.end = end;
  path.start_width = path.end_width = 1.7;
  path.pair = pair;
  return path;
}

Vec3d turned(Vec3d p, double angle) {
  return {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
}

/// Two spheres that do not touch, as one mesh.
Mesh two_spheres(Vec3d a, Vec3d b) {
  Mesh mesh = icosphere(3, 2.0, a);
  const Mesh other = icosphere(3, 2.0, b);
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("slip");

TEST_CASE("a surface that goes with its atoms does not slip, whether they rotate or not") {
  const Mesh sphere = icosphere(4, 2.0);
  for (const auto& engine : back_ends()) {
    for (const double angle : {0.0, 0.7}) {
      MovingAtom path = atom({}, {3, -1, 2}, 0);
      path.own_rotation = {0, 0, angle};
      const Mesh there = moved(sphere, [&](Vec3d p) { return turned(p, angle) + path.end; });
      const auto source = engine->upload_mesh(sphere), mapped = engine->upload_mesh(there);
      for (const float slip : engine->slip(source, mapped, mapped, {path})) CHECK(slip < 1e-4F);
    }
  }
}

TEST_CASE("a surface that rotates about an atom at rest slips by the chord") {
  const Mesh sphere = icosphere(4, 2.0);
  const double angle = 0.5;
  for (const auto& engine : back_ends()) {
    const auto source = engine->upload_mesh(sphere);
    const auto mapped = engine->upload_mesh(moved(sphere, [&](Vec3d p) { return turned(p, angle); }));
    const std::vector<float> slip = engine->slip(source, mapped, source, {atom({}, {}, 0)});
    for (std::size_t v = 0; v < slip.size(); ++v) {
      const double axis_distance = std::hypot(sphere.positions[v].x, sphere.positions[v].y);
      CHECK(static_cast<double>(slip[v]) == doctest::Approx(2 * std::sin(angle / 2) * axis_distance).epsilon(1e-3));
    }
  }
}

TEST_CASE("a surface that stays while its atoms change places slips by their distance") {
  const Vec3d a{-6, 0, 0}, b{6, 0, 0};
  const Mesh both = two_spheres(a, b);
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(both);
    for (const float slip : engine->slip(mesh, mesh, mesh, {atom(a, a, 0), atom(b, b, 1)})) CHECK(slip < 1e-4F);
    for (const float slip : engine->slip(mesh, mesh, mesh, {atom(a, b, 0), atom(b, a, 1)}))
      CHECK(slip == doctest::Approx(12).epsilon(1e-3));
  }
}

TEST_CASE("the place is one that the atom's partner owns, not the nearest of the surface") {
  // The atom at `a` goes between the spheres, nearer to the wrong one; its partner owns the sphere at b only.
  const Vec3d a{-6, 0, 0}, b{6, 0, 0};
  const Mesh both = two_spheres(a, b);
  MovingAtom carried = atom(a, {-2, 0, 0}, 1);
  carried.at_end = false;
  MovingAtom owner = atom({-6, 0, 0}, b, 1);
  owner.at_start = false;
  MovingAtom other = atom({-6, 0, 0}, a, 0);
  other.at_start = false;
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(both);
    const std::vector<float> slip = engine->slip(mesh, mesh, mesh, {carried, owner, other});
    for (std::size_t v = 0; v < slip.size() / 2; ++v) CHECK(slip[v] > 7.0F);
  }
}

TEST_CASE("without partners there is no slip, and meshes of different sizes are refused") {
  const Mesh sphere = icosphere(2, 2.0);
  for (const auto& engine : back_ends()) {
    const auto mesh = engine->upload_mesh(sphere);
    for (const float slip : engine->slip(mesh, mesh, mesh, {atom({}, {}, -1), atom({40, 0, 0}, {40, 0, 0}, 0)}))
      CHECK(std::isnan(slip));
    CHECK_THROWS_AS(engine->slip(mesh, engine->upload_mesh(icosphere(3, 2.0)), mesh, {atom({}, {}, 0)}),
                    espdiff::GeometryError);
  }
}

TEST_SUITE_END();
