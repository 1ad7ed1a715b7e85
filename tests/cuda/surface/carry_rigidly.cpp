// carry_rigidly.cpp: a mesh moves with the rigid motions of its atoms.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::RigidTransform;

namespace {

/// A quarter turn about z, and a translation.
RigidTransform quarter_turn(Vec3d shift) {
  RigidTransform motion;
  const double rotation[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  std::copy(rotation, rotation + 9, motion.rotation);
  motion.translation = shift;
  return motion;
}

}  // namespace

TEST_SUITE_BEGIN("carry_rigidly");

TEST_CASE("one motion for all atoms moves the mesh rigidly; no motion leaves it") {
  AtomSet atoms = random_cloud(150, 31);
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms.residues[i] = static_cast<std::int32_t>(i % 3);
  const RigidTransform motion = quarter_turn({1, 2, 3});
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto mesh = engine->isosurface(engine->density(uploaded, 1.0), 0.5F);
    const Mesh before = engine->download(mesh);
    const Mesh still = engine->download(engine->carry_rigidly(mesh, uploaded, {-1, -1, -1}, {motion}));
    const Mesh turned = engine->download(engine->carry_rigidly(mesh, uploaded, {0, 0, 0}, {motion}));
    CHECK(before.triangles == turned.triangles);
    double off = 0, moved = 0;
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
      moved = std::max(moved, static_cast<double>(norm(still.positions[v] - before.positions[v])));
      const Vec3d expected = motion.apply(static_cast<Vec3d>(before.positions[v]));
      off = std::max(off, norm(static_cast<Vec3d>(turned.positions[v]) - expected));
    }
    CHECK(moved == 0);
    CHECK(off < 1e-4);
  }
}

TEST_CASE("between two domains the motions blend by density; away from the seam each moves with its own") {
  AtomSet atoms;
  for (int i = 0; i <= 20; ++i) atoms.add({static_cast<double>(i) - 10, 0.3 * (i % 2), 0}, 1.7);
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms.residues[i] = i < 10 ? 0 : 1;
  RigidTransform up;
  up.translation = {0, 0, 4};
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto mesh = engine->isosurface(engine->density(uploaded, 1.0), 0.5F);
    const Mesh before = engine->download(mesh),
               after = engine->download(engine->carry_rigidly(mesh, uploaded, {-1, 0}, {up}));
    std::size_t n_between = 0;
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
      const Vec3f p = before.positions[v], move = after.positions[v] - p;
      CHECK(move.x == 0);
      CHECK(move.y == 0);
      // By hand, in double precision.
      double own = 0, all = 0;
      for (std::size_t i = 0; i < atoms.size(); ++i) {
        const Vec3d d = static_cast<Vec3d>(p) - atoms.positions[i];
        const double gaussian = std::exp(-dot(d, d) / (2 * 1.7 * 1.7));
        all += gaussian;
        own += i < 10 ? 0 : gaussian;
      }
      CHECK(std::fabs(static_cast<double>(move.z) - 4 * own / all) < 0.01);
      n_between += move.z > 0.4F && move.z < 3.6F ? 1 : 0;
    }
    CHECK(n_between > 10);
  }
}

TEST_CASE("a residue with an invalid motion index is refused") {
  AtomSet atoms = random_cloud(30, 32);
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const auto mesh = engine->isosurface(engine->density(uploaded, 1.0), 0.5F);
    CHECK(message_of([&] {
            engine->carry_rigidly(mesh, uploaded, {2}, {{}, {}});
          }) == "a residue belongs to rigid domain 2 of 2");
  }
}

TEST_SUITE_END();
