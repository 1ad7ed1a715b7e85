// adversarial.cpp: changes that no mapping handles everywhere: each is either mapped or reported, never wrong with a
// clean certificate.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "base/error.h"
#include "compare/built_molecule.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "options/options.h"

using namespace espdiff_test;
using espdiff::compare;

namespace {

using AtomMotion = std::function<Vec3d(std::size_t atom, Vec3d p)>;

Molecule moved(Molecule molecule, const AtomMotion& motion) {
  for (std::size_t i = 0; i < molecule.size(); ++i) molecule.positions[i] = motion(i, molecule.positions[i]);
  return molecule;
}

/// Must hold in all cases: if the certificate is clean, an independent check finds no fault.
CompareResult mapped_or_reported(const char* name, const Molecule& source, const Molecule& target,
                                 espdiff::AlignAtoms align = espdiff::AlignAtoms::kNone) {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CompareOptions options;
  options.align = align;
  const CompareResult r = compare(*engine, {&source, nullptr}, {&target, nullptr}, options, {});
  const espdiff::Certificate& c = r.certificate;
  std::printf(
      "%s: %s; unmatched %.2f %% of the source, %.2f %% of the target; target to mapped at most %.2f A; "
      "same residue %.1f %%; %zu vertices added, %zu lost\n",
      name, c.trustworthy ? "trustworthy" : "NOT trustworthy", 100 * c.unmatched_source, 100 * c.unmatched_target,
      c.target_to_mapped.max, 100 * c.same_residue_area_fraction, r.mapping.morph.n_vertices_added,
      r.mapping.morph.n_vertices_unmatched);
  for (const espdiff::Message& reason : c.reasons) std::printf("    %s\n", reason.plain().c_str());
  CHECK(c.trustworthy == c.reasons.empty());
  CHECK(c.self_intersecting_pairs == 0);
  CHECK(c.flipped_area_fraction == 0);
  CHECK(c.corrupt_area_fraction <= 1e-3);

  // Every valid vertex lies on the target's surface, by a direct sum of the density.
  const espdiff::MappedSurface& s = r.surface;
  std::vector<bool> counts(s.positions.size(), false);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.unmatched[t] != 0) continue;
    for (const std::uint32_t v : s.triangles[t]) counts[v] = true;
  }
  double worst = 0;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    CHECK(counts[v] == std::isfinite(s.displacement[v]));
    if (!counts[v]) continue;
    double density = 0;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const Vec3d d = s.positions[v] - target.positions[i];
      const double width = static_cast<double>(target.radii[i]);
      density += std::exp(-dot(d, d) / (2 * width * width));
    }
    worst = std::max(worst, std::fabs(density - 0.5));
  }
  CHECK(worst < 0.05);
  return r;
}

}  // namespace

TEST_SUITE_BEGIN("adversarial");

TEST_CASE("two chains that separate: the faces of the contact are unmatched") {
  Builder b;
  b.add_ball(1, {0, 0, 0}, 7);
  const std::size_t n_first = b.molecule.size();
  b.add_ball(2, {15, 0, 0}, 7);
  const Molecule target = moved(b.molecule, [&](std::size_t i, Vec3d p) {
    return i < n_first ? p : p + Vec3d{12, 0, 0};
  });
  const CompareResult r = mapped_or_reported("separating chains", b.molecule, target);
  CHECK(r.certificate.same_residue_area_fraction > 0.97);
  CHECK(r.certificate.unmatched_target > 0.01);
}

TEST_CASE("two chains that meet: the buried surface is unmatched") {
  Builder b;
  b.add_ball(1, {0, 0, 0}, 7);
  const std::size_t n_first = b.molecule.size();
  b.add_ball(2, {27, 0, 0}, 7);
  const Molecule target = moved(b.molecule, [&](std::size_t i, Vec3d p) {
    return i < n_first ? p : p - Vec3d{12, 0, 0};
  });
  const CompareResult r = mapped_or_reported("meeting chains", b.molecule, target);
  CHECK(r.certificate.same_residue_area_fraction > 0.97);
  CHECK(r.certificate.unmatched_source > 0.01);
}

TEST_CASE("a closed cavity that opens") {
  Builder b;
  int k = 0;
  for (int i = 0; i < 400; ++i) {  // points of a Fibonacci lattice on a sphere
    const double z = 1 - (2 * i + 1) / 400.0, r = std::sqrt(1 - z * z), phi = i * 2.399963229728653;
    b.add("SHL", z > 0.75 ? 2 : 1, "C" + std::to_string(++k), 11.0 * Vec3d{r * std::cos(phi), r * std::sin(phi), z});
  }
  const Molecule target = moved(b.molecule, [&](std::size_t, Vec3d p) {
    const double z = p.z / 11.0;
    return z > 0.75 ? p + Vec3d{0, 0, 14} : p;  // the lid is lifted off
  });
  const CompareResult r = mapped_or_reported("opened cavity", b.molecule, target);
  CHECK(r.source_surface.n_cavities_left_out == 1);
  // Its wall is part of the target's surface now and was mapped there.
  CHECK(r.certificate.unmatched_target < 0.05);
}

TEST_CASE("a tunnel that forms") {
  Builder b;
  int k = 0;
  for (int x = -6; x <= 6; ++x)
    for (int y = -6; y <= 6; ++y)
      for (int z = -1; z <= 1; ++z) b.add("SLB", 1, "C" + std::to_string(++k), {2.0 * x, 2.0 * y, 2.0 * z});
  const Molecule target = moved(b.molecule, [&](std::size_t, Vec3d p) {
    const double r = std::hypot(p.x, p.y);
    const double out = r < 1e-9 ? 0 : std::sqrt(r * r + 30) / r;  // preserves area: a hole of radius 5.5 A
    return Vec3d{p.x * out + (r < 1e-9 ? 5.5 : 0), p.y * out, p.z};
  });
  mapped_or_reported("tunnel", b.molecule, target);
}

TEST_CASE("a loop that swings by 10 A") {
  Builder b;
  b.add_ball(1, {0, 0, 0}, 9);
  const std::size_t n_ball = b.molecule.size();
  for (int i = 0; i < 12; ++i) b.add("LOP", 2 + i, "CA", {9.0 + 1.5 * i, 0, 0});
  const Molecule target = moved(b.molecule, [&](std::size_t i, Vec3d p) {
    if (i < n_ball) return p;
    const double along = p.x - 9.0, angle = 0.65;
    return Vec3d{9.0 + along * std::cos(angle), along * std::sin(angle), 0};
  });
  const CompareResult r = mapped_or_reported("swinging loop", b.molecule, target);
  CHECK(r.certificate.trustworthy);
  CHECK(r.certificate.same_residue_area_fraction > 0.85);  // residues of one atom, 1.5 A apart
  CHECK(r.certificate.target_to_mapped.max < 1);
}

TEST_CASE("a ligand that appears, bound and free") {
  Builder b;
  b.add_ball(1, {0, 0, 0}, 9);
  for (const double distance : {12.0, 22.0}) {
    Builder with = b;
    with.add_ball(2, {distance, 0, 0}, 3);
    const CompareResult r =
        mapped_or_reported(distance < 15 ? "bound ligand" : "free ligand", b.molecule, with.molecule);
    const CompareResult back =
        mapped_or_reported(distance < 15 ? "bound ligand leaves" : "free ligand leaves", with.molecule, b.molecule);
    if (distance > 15) {
      CHECK(r.certificate.unmatched_target > 0.05);
      CHECK(back.certificate.unmatched_source > 0.05);
    }
  }
}

TEST_CASE("one atom against two is refused: there is nothing to pair") {
  Builder one, two;
  one.add("ION", 1, "NA", {0, 0, 0});
  two.add("ION", 1, "NA", {0, 0, 0});
  two.add("ION", 2, "NA", {5, 0, 0});
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  CompareOptions options;
  options.align = espdiff::AlignAtoms::kNone;
  CHECK_THROWS_WITH_AS(compare(*engine, {&one.molecule, nullptr}, {&two.molecule, nullptr}, options, {}),
                       doctest::Contains("the morph needs paired atoms"), espdiff::InputError);
}

TEST_SUITE_END();
