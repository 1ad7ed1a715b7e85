// solute_shape_forms.cpp: depths below the solvent-excluded surface: by planes and by points the same bits, and right
// against probes put everywhere.
#include <doctest/doctest.h>

#include <cstring>

#include "cuda/potential/pb/dielectric_map.h"
#include "support/random.h"

using namespace espdiff_test;
using espdiff::cpu_backend::Buffer;
using espdiff::cpu_backend::CubicLattice;
using espdiff::cpu_backend::PbAtom;
using espdiff::cpu_backend::SoluteShape;
using espdiff::cpu_backend::to_host;

namespace {

std::vector<PbAtom> random_cluster(int n, double half_side, std::uint64_t seed) {
  Random random(seed);
  std::vector<PbAtom> atoms;
  for (int i = 0; i < n; ++i)
    atoms.push_back({random.in_box(half_side), static_cast<float>(random.uniform(1.0, 2.0)), 0.0F});
  return atoms;
}

CubicLattice lattice_around(double half_side, double spacing) {
  const int n = static_cast<int>(2 * half_side / spacing) + 1;
  const float low = static_cast<float>(-half_side);
  return {{n, n, n}, {low, low, low}, static_cast<float>(spacing)};
}

}  // namespace

TEST_SUITE_BEGIN("solute_shape_forms");

TEST_CASE("by planes and by points: the same bits") {
  const auto atoms = random_cluster(150, 7, 3);
  const CubicLattice lattice = lattice_around(11, 0.45);
  for (const float probe : {0.0F, 0.2F, 1.4F, 3.0F}) {
    const SoluteShape shape(atoms, probe);
    Buffer<float> by_planes, by_points;
    shape.depths_by_planes(lattice, by_planes);
    shape.depths_by_points(lattice, by_points);
    CAPTURE(probe);
    CHECK(std::memcmp(to_host(by_planes).data(), to_host(by_points).data(), by_planes.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("depths are distances to where a probe may be, less its radius") {
  const auto atoms = random_cluster(14, 3.0, 4);
  constexpr float kProbe = 1.4F;
  // Where a probe's centre may be, on a fine lattice: distances to it err by a lattice step.
  constexpr double kFine = 0.12;
  std::vector<Vec3d> free;
  for (double x = -7; x <= 7; x += kFine) {
    for (double y = -7; y <= 7; y += kFine) {
      for (double z = -7; z <= 7; z += kFine) {
        double gap = 1e9;
        for (const PbAtom& a : atoms)
          gap = std::min(gap, norm(Vec3d{x, y, z} - a.position) - static_cast<double>(a.radius + kProbe));
        if (gap >= 0 && gap < 0.25) free.push_back({x, y, z});  // its rim suffices
      }
    }
  }
  const CubicLattice lattice = lattice_around(5, 0.5);
  Buffer<float> buffer;
  SoluteShape(atoms, kProbe).depths(lattice, buffer);
  const std::vector<float> depths = to_host(buffer);
  int n = 0;
  double worst = 0;
  for (std::size_t p = 0; p < depths.size(); p += 3) {
    const int i = static_cast<int>(p) % lattice.size[0], j = static_cast<int>(p) / lattice.size[0] % lattice.size[1];
    const Vec3d x = static_cast<Vec3d>(lattice.point(i, j, static_cast<int>(p) / (lattice.size[0] * lattice.size[1])));
    bool outside = true;
    for (const PbAtom& a : atoms) outside = outside && norm(x - a.position) > static_cast<double>(a.radius + kProbe);
    if (outside) {
      CHECK(depths[p] < 0);
      continue;
    }
    double nearest = 1e9;
    for (const Vec3d& c : free) nearest = std::min(nearest, norm(c - x));
    const double wanted = nearest - static_cast<double>(kProbe);
    if (wanted > 0.3) {
      CHECK(depths[p] > 0);
    } else {
      // The lattice can only miss the nearest place.
      CHECK(static_cast<double>(depths[p]) < wanted + 0.005);
      worst = std::max(worst, wanted - static_cast<double>(depths[p]));
      ++n;
    }
  }
  CAPTURE(n);
  CHECK(n > 300);
  CHECK(worst < 0.15);
}

TEST_SUITE_END();
