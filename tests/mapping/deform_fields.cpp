// deform_fields.cpp: the method deform in each of its fields, its subdivision, and its path lengths.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "compare/compare.h"
#include "compare/made_side.h"
#include "compare/series.h"
#include "cuda/surface/back_ends.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::DeformField;
using espdiff::StartFrom;

namespace {

CompareOptions deform_in(DeformField field, bool subdivide = false) {
  CompareOptions options;
  options.method = espdiff::Method::kDeform;
  options.field = field;
  options.subdivide = subdivide;
  return options;
}

/// Two states of ubiquitin with different positions of its tail.
struct Ubiquitin {
  Molecule source, target;
};

std::optional<Ubiquitin> ubiquitin() {
  const auto source = real_input("series19_ubq_2k39/m00.pqr"), target = real_input("series19_ubq_2k39/m07.pqr");
  if (!source || !target) return std::nullopt;
  return Ubiquitin{espdiff::read_structure(*source), espdiff::read_structure(*target)};
}

}  // namespace

TEST_SUITE_BEGIN("fields of deform");

TEST_CASE(
    "in every field, with and without subdivision, deform converges, and paths are no shorter than displacements") {
  const Side source = make_side(1, 0), target = make_side(2, 0.4);
  for (const auto& engine : back_ends()) {
    for (const DeformField field :
         {DeformField::kDensity, DeformField::kDistance, DeformField::kGvf, DeformField::kGvf2}) {
      for (const bool subdivide : {false, true}) {
        const CompareResult r = compare(*engine, source.input(), target.input(), deform_in(field, subdivide), {});
        CAPTURE(to_string(field));
        CAPTURE(subdivide);
        CHECK(r.mapping.deform.converged);
        CHECK(r.certificate.mapped_to_target.mean < 0.05);
        CHECK(r.certificate.corrupt_area_fraction < 0.02);
        const bool flows = field == DeformField::kGvf || field == DeformField::kGvf2;
        CHECK((r.mapping.flow.sweeps > 0) == flows);
        CHECK(r.mapping.flow.converged == flows);
        if (!subdivide) CHECK(r.mapping.n_vertices_subdivided == 0);
        REQUIRE(r.surface.path_length.size() == r.surface.positions.size());
        const std::size_t n_old = r.surface.positions.size() - r.mapping.n_vertices_subdivided;
        float least = 1;
        for (std::size_t v = 0; v < n_old; ++v)
          least = std::min(least, r.surface.path_length[v] - r.surface.displacement[v]);
        CHECK(least > -1e-4F);
        CHECK(r.potential.metrics.mean_path_length_A > r.potential.metrics.mean_displacement_A);
        // They oscillate about the surface before they rest: 0.075 A, half of it back, and so on.
        CHECK(r.potential.metrics.mean_path_length_A < r.potential.metrics.mean_displacement_A + 0.3);
      }
    }
  }
}

TEST_CASE("subdivision reaches missed parts, and its vertices come from the source's surface") {
  const auto pair = ubiquitin();
  if (!pair) return;
  const Molecule &source = pair->source, &target = pair->target;
  for (const auto& engine : back_ends()) {
    CompareResult results[2];
    for (const bool subdivide : {false, true}) {
      results[subdivide ? 1 : 0] =
          compare(*engine, {&source, nullptr}, {&target, nullptr}, deform_in(DeformField::kDistance, subdivide), {});
    }
    const CompareResult &without = results[0], &with = results[1];
    std::printf(
        "ubiquitin m00/m07, %s: corrupt area %.3f %%, target to mapped at most %.2f A; with subdivision %.3f %%, %.2f "
        "A\n",
        engine->back_end().c_str(), 100 * without.certificate.corrupt_area_fraction,
        without.certificate.target_to_mapped.max, 100 * with.certificate.corrupt_area_fraction,
        with.certificate.target_to_mapped.max);
    CHECK(with.mapping.n_vertices_subdivided > 100);
    CHECK(with.certificate.target_to_mapped.max < 0.2 * without.certificate.target_to_mapped.max);
    CHECK(with.certificate.corrupt_area_fraction < 0.1 * without.certificate.corrupt_area_fraction);
    // The maximum number of iterations applies to all rounds together.
    CompareOptions hurried = deform_in(DeformField::kDistance, true);
    hurried.deform.max_iterations = without.mapping.deform.iterations + 7;
    const CompareResult stopped = compare(*engine, {&source, nullptr}, {&target, nullptr}, hurried, {});
    CHECK(stopped.mapping.deform.iterations == hurried.deform.max_iterations);
    CHECK_FALSE(stopped.certificate.converged);
    // With radii as widths the density at a source position is the isovalue.
    std::vector<float> widths(source.radii.begin(), source.radii.end());
    const auto atoms =
        engine->upload_atoms(source.positions, widths, std::vector<std::int32_t>(source.positions.size(), 0));
    std::vector<Vec3f> added;
    const std::size_t n_old = with.surface.positions.size() - with.mapping.n_vertices_subdivided;
    for (std::size_t v = n_old; v < with.surface.positions.size(); ++v)
      added.push_back(static_cast<Vec3f>(with.surface.source_positions[v]));
    std::size_t n_off = 0;
    for (const float density : engine->density_at(atoms, added)) n_off += std::fabs(density - 0.5F) > 0.01F ? 1 : 0;
    CHECK(n_off == 0);
    // The old vertices equal those of the mapping without subdivision.
    CHECK(std::equal(without.surface.source_positions.begin(), without.surface.source_positions.end(),
                     with.surface.source_positions.begin(), [](Vec3d a, Vec3d b) { return norm(a - b) < 1e-9; }));
  }
}

TEST_CASE("a surface mapped onto itself is not subdivided, and its paths are short") {
  const Side side = make_side(1, 0);
  for (const auto& engine : back_ends()) {
    for (const DeformField field : {DeformField::kDistance, DeformField::kGvf2}) {
      const CompareResult r = compare(*engine, side.input(), side.input(), deform_in(field, true), {});
      CHECK(r.potential.metrics.mean_displacement_A < 0.03);
      CHECK(r.potential.metrics.mean_path_length_A < 0.5);
      CHECK(r.mapping.n_vertices_subdivided < r.surface.positions.size() / 100);
    }
  }
}

TEST_CASE("the morph's paths are as long as the displacement where atoms move straight") {
  Side source = make_side(1, 0), target = source;
  for (Vec3d& p : target.molecule.positions) p.x += 2.0;
  for (const auto& engine : back_ends()) {
    CompareOptions options;
    options.align = espdiff::AlignAtoms::kNone;
    const CompareResult r = compare(*engine, source.shape(), target.shape(), options, {});
    REQUIRE(r.surface.path_length.size() == r.surface.positions.size());
    float shortest = 10, longest = 0;
    for (const float length : r.surface.path_length) {
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    CHECK(shortest > 1.99F);
    CHECK(longest < 2.1F);
  }
}

TEST_CASE("a series continues from a subdivided step with the source's own vertices") {
  const auto pair = ubiquitin();
  if (!pair) return;
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  espdiff::Series series(*engine, {&pair->source, nullptr}, deform_in(DeformField::kGvf2, true));
  const CompareResult first = series.step({&pair->target, nullptr}, StartFrom::kPrevious, {});
  CHECK(first.mapping.n_vertices_subdivided > 0);
  REQUIRE(series.state().has_value());
  CHECK(series.state()->mapped.size() == first.surface.positions.size() - first.mapping.n_vertices_subdivided);
  const CompareResult second = series.step({&pair->target, nullptr}, StartFrom::kPrevious, {});
  CHECK(second.mapping.start == StartFrom::kPrevious);
  CHECK(second.certificate.mapped_to_target.mean < 0.05);
}

TEST_SUITE_END();
