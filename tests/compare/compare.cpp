// compare.cpp: the whole comparison: rigid copies, invariances, point charges, determinism, and every error message.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "cuda/surface/back_ends.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "mapping/input.h"
#include "options/options.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::compare;
using espdiff::RigidTransform;

namespace {

Side moved_side(Side side, const RigidTransform& t) {
  for (Vec3d& p : side.molecule.positions) p = t.apply(p);
  side.map.lattice.origin = t.apply(side.map.lattice.origin);
  for (Vec3d& step : side.map.lattice.step) step = t.rotate(step);
  return side;
}

void check_close(const CompareResult& a, const CompareResult& b, double tolerance) {
  CHECK(a.potential.metrics.area_A2 == doctest::Approx(b.potential.metrics.area_A2).epsilon(tolerance));
  CHECK(a.potential.metrics.mean_abs_difference ==
        doctest::Approx(b.potential.metrics.mean_abs_difference).epsilon(tolerance));
  CHECK(a.potential.metrics.rms_difference == doctest::Approx(b.potential.metrics.rms_difference).epsilon(tolerance));
  CHECK(std::fabs(a.potential.metrics.mean_signed_difference - b.potential.metrics.mean_signed_difference) <
        tolerance * b.potential.metrics.mean_abs_difference);
  CHECK(std::fabs(a.potential.metrics.sign_change_area_fraction - b.potential.metrics.sign_change_area_fraction) <
        tolerance);
  CHECK(a.potential.metrics.hodgkin_index == doctest::Approx(b.potential.metrics.hodgkin_index).epsilon(tolerance));
  CHECK(a.potential.metrics.mean_displacement_A ==
        doctest::Approx(b.potential.metrics.mean_displacement_A).epsilon(tolerance));
  CHECK(a.rmsd_A == doctest::Approx(b.rmsd_A).epsilon(1e-9));
}

}  // namespace

TEST_SUITE_BEGIN("compare");

TEST_CASE("a rigid copy with its map differs by almost nothing") {
  const Side source = make_side(1, 0), target = moved_side(source, rigid({0.6, 0, 0.8}, 2.1, {30, -20, 55}));
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, source.input(), target.input(), quick_options(), {});
    double size = 0;
    for (const float value : r.surface.potential_source)
      size += std::fabs(static_cast<double>(value)) / static_cast<double>(r.surface.positions.size());
    std::printf(
        "rigid copy, %s: mean |difference| %.2e of mean |potential| %.3f, rms %.2e, displacement %.4f A, rmsd %.1e A\n",
        engine->back_end().c_str(), r.potential.metrics.mean_abs_difference, size, r.potential.metrics.rms_difference,
        r.potential.metrics.mean_displacement_A, r.rmsd_A);
    CHECK(r.rmsd_A < 1e-6);
    CHECK(r.potential.metrics.mean_abs_difference < 0.01 * size);
    CHECK(r.potential.metrics.mean_displacement_A < 0.03);
    CHECK(r.potential.metrics.sign_change_area_fraction < 0.01);
    CHECK(r.potential.metrics.hodgkin_index > 0.999);
    CHECK(r.certificate.mapped_to_target.mean < 0.02);
    CHECK(r.certificate.corrupt_area_fraction < 1e-3);
    CHECK(r.certificate.converged);
    CHECK(r.potential.n_outside_source_map == 0);
    CHECK(r.potential.n_outside_target_map == 0);
    // Every vertex lies in its own frame; the motion relates the two up to the displacement.
    double worst = 0, least_cosine = 1;
    for (std::size_t v = 0; v < r.surface.positions.size(); ++v) {
      const Vec3d there = r.alignment.source_to_target.apply(r.surface.source_positions[v]);
      worst = std::max(
          worst, std::fabs(norm(r.surface.positions[v] - there) - static_cast<double>(r.surface.displacement[v])));
      const Vec3d turned = r.alignment.source_to_target.rotate(static_cast<Vec3d>(r.surface.source_normals[v]));
      least_cosine = std::min(least_cosine, dot(turned, static_cast<Vec3d>(r.surface.normals[v])));
    }
    CHECK(worst < 1e-4);
    CHECK(least_cosine > 0.99);
  }
}

TEST_CASE("a rigid motion of either side, and the order of atoms in a residue, change nothing") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  Side shuffled = b;
  for (std::size_t i = 0; i + 9 < shuffled.molecule.size(); i += 10) {
    for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{1, 6}, {3, 8}, {5, 9}}) {
      std::swap(shuffled.molecule.atoms[i + from], shuffled.molecule.atoms[i + to]);
      std::swap(shuffled.molecule.positions[i + from], shuffled.molecule.positions[i + to]);
      std::swap(shuffled.molecule.radii[i + from], shuffled.molecule.radii[i + to]);
    }
  }
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, a.input(), b.input(), quick_options(), {});
    std::printf("pair of clouds, %s: mean |difference| %.4f, displacement %.4f A, rmsd %.3f A\n",
                engine->back_end().c_str(), r.potential.metrics.mean_abs_difference,
                r.potential.metrics.mean_displacement_A, r.rmsd_A);
    CHECK(r.potential.metrics.mean_abs_difference > 0.01);
    const RigidTransform motion = rigid({0, 0.6, 0.8}, 1.3, {12, 34, -56}), other = rigid({1, 0, 0}, 2.7, {-70, 8, 9});
    const auto metrics_of = [&](const Side& s, const Side& t) {
      return compare(*engine, s.input(), t.input(), quick_options(), {});
    };
    check_close(metrics_of(moved_side(a, motion), b), r, 1e-3);
    check_close(metrics_of(a, moved_side(b, motion)), r, 1e-3);
    check_close(metrics_of(moved_side(a, motion), moved_side(b, other)), r, 1e-3);
    check_close(metrics_of(a, shuffled), r, 1e-3);
  }
}

TEST_CASE("samples equal the point charges' potential at the vertices") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, a.input(), b.input(), quick_options(), {});
    const auto worst_error = [](const Side& side, const std::vector<Vec3d>& positions,
                                const std::vector<float>& samples) {
      double worst = 0;
      for (std::size_t v = 0; v < positions.size(); ++v) {
        double exact = 0;
        for (std::size_t i = 0; i < side.molecule.size(); ++i) {
          const Vec3d d = positions[v] - side.molecule.positions[i];
          exact += static_cast<double>(side.molecule.charges[i]) / std::sqrt(dot(d, d) + 4);
        }
        worst = std::max(worst, std::fabs(static_cast<double>(samples[v]) - exact));
      }
      return worst;
    };
    // Linear interpolation over 1 A of a charge smoothed over 2 A: up to 3 / 8 of its second derivative, 1 / 8.
    CHECK(worst_error(a, r.surface.source_positions, r.surface.potential_source) < 0.05);
    CHECK(worst_error(b, r.surface.positions, r.surface.potential_target) < 0.05);
  }
}

TEST_CASE("maps in two known units are compared in the source's") {
  const Side a = make_side(1, 0);
  Side b = make_side(2, 0.3);
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, a.input(), b.input(), quick_options(), {});
    Side in_volt = b;
    in_volt.map.unit = PotentialUnit::kVolt;
    for (float& value : in_volt.map.values)
      value = static_cast<float>(value * 0.0258519998);  // kT/e at 300 K, CODATA 2018
    const CompareResult s = compare(*engine, a.input(), in_volt.input(), quick_options(), {});
    CHECK(s.potential.unit == PotentialUnit::kKtPerE);
    CHECK(s.potential.metrics.mean_abs_difference ==
          doctest::Approx(r.potential.metrics.mean_abs_difference).epsilon(1e-5));
  }
}

TEST_CASE("without maps only shapes are compared; the residues' areas sum to the total") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, a.shape(), b.shape(), quick_options(), {});
    CHECK_FALSE(r.potential.compared);
    CHECK(r.surface.potential_source.empty());
    double area = 0;
    for (const auto& row : r.residues) area += row.area_A2;
    double valid = 0;
    const auto& s = r.surface;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
      const Vec3d p = s.positions[s.triangles[t][0]];
      if (s.corrupt[t] == 0)
        valid += 0.5 * norm(cross(s.positions[s.triangles[t][1]] - p, s.positions[s.triangles[t][2]] - p));
    }
    CHECK(area == doctest::Approx(valid).epsilon(1e-9));
    CHECK(std::isnan(r.residues[0].mean_abs_difference));
  }
}

TEST_CASE("a real pair gives the same bits for 1, 2 and 4 threads, and again") {
  const auto path = real_input("series19_ubq_2k39/m00.pqr"), other = real_input("series19_ubq_2k39/m01.pqr");
  Side a = make_side(1, 0), b = make_side(2, 0.3);
  if (path) {
    a.molecule = espdiff::read_structure(*path);
    b.molecule = espdiff::read_structure(*other);
    for (Side* side : {&a, &b}) side->map = potential_map(side->molecule, 3.0);
  }
  for (const auto field : {espdiff::DeformField::kDistance, espdiff::DeformField::kDensity}) {
    CompareOptions options = quick_options();
    options.regularize.max_iterations = options.deform.max_iterations = 40;
    options.surface.grid_spacing_A = 1.5;
    options.field = field;
    const auto one = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
    const std::uint64_t expected = hash_of(compare(*one, a.input(), b.input(), options, {}));
    CHECK(hash_of(compare(*one, a.input(), b.input(), options, {})) == expected);
    for (const int n_threads : {2, 4}) {
      const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads);
      CHECK(hash_of(compare(*engine, a.input(), b.input(), options, {})) == expected);
    }
  }
}

TEST_CASE("compare refuses invalid input with a remedy") {
  const Side a = make_side(1, 0, 80), b = make_side(2, 0.3, 80);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const auto message = [&](const CompareInput& source, const CompareInput& target,
                           const CompareOptions& options = quick_options()) {
    return message_of([&] { compare(*engine, source, target, options, {}); });
  };
  CHECK(message(a.input(), b.shape()) ==
        "a potential map was given for the source only; give one for the target too (target-map), or "
        "none to compare shapes alone");
  CHECK(message(a.shape(), b.input()).find("a potential map was given for the target only") == 0);
  Side unknown = b;
  unknown.map.unit = PotentialUnit::kUnknown;
  CHECK(message(a.input(), unknown.input()) ==
        "the maps are in two units: kT/e (map.dx) and unknown (map.dx); name the unknown "
        "one's unit (target-map-unit)");
  Side elsewhere = b;
  elsewhere.map.lattice.origin += Vec3d{500, 0, 0};
  CHECK(message(a.input(), elsewhere.input()) ==
        "map.dx: the map does not cover the molecule: no vertex of the surface lies in it; compute the "
        "map around this molecule, in the coordinates of the structure file");
  Side stranger = b;
  for (auto& atom : stranger.molecule.atoms) atom.name = "X" + atom.name;
  for (auto& residue : stranger.molecule.residues) residue.name = "UNK";
  CHECK_THROWS_AS(compare(*engine, a.input(), stranger.input(), quick_options(), {}), espdiff::InputError);

  const auto with = [&](auto change) {
    CompareOptions options = quick_options();
    change(options.surface);
    return message(a.input(), b.input(), options);
  };
  CHECK(with([](auto& s) { s.isovalue = 1e3; }).find("no surface: the density reaches ") == 0);
  CHECK(with([](auto& s) { s.isovalue = 0; }) == "isovalue 0 is not positive; 0.5 is usual");
  CHECK(with([](auto& s) { s.radius_scale = 0; }) == "radius scale 0 is not positive; 1 is usual");
  CHECK(with([](auto& s) { s.grid_spacing_A = 0; }) == "grid spacing 0 A is not a positive number; 1 is usual");
  const std::string text = with([](auto& s) { s.grid_spacing_A = 1e-4; });
  CHECK(text.find("a grid of spacing 0.0001 A") == 0);
  CHECK(text.find(" A would fit") != std::string::npos);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(with([&](auto& s) { s.isovalue = bad; }).find("is not positive") != std::string::npos);
    CHECK(with([&](auto& s) { s.radius_scale = bad; }).find("is not positive") != std::string::npos);
    CHECK(with([&](auto& s) { s.grid_spacing_A = bad; }).find("is not a positive number") != std::string::npos);
  }
}

TEST_CASE("surface outside a map is counted, excluded and not trusted") {
  const Side a = make_side(1, 0), b = make_side(2, 0.3);
  Side part = b;
  part.map.lattice.size[2] /= 2;  // half of the layers; z is slowest, so the values stay in place
  part.map.values.resize(part.map.lattice.n_points());
  for (const auto& engine : back_ends()) {
    const CompareResult r = compare(*engine, a.input(), part.input(), quick_options(), {});
    CHECK(r.potential.n_outside_target_map > 0);
    CHECK(r.potential.n_outside_source_map == 0);
    CHECK(r.potential.metrics.area_A2 < 0.8 * r.area_mapped_A2);
    CHECK(std::isfinite(r.potential.metrics.mean_abs_difference));
    CHECK(r.certificate.outside_maps > 0.05);
    CHECK(r.certificate.outside_maps < 1 - r.potential.metrics.area_A2 / r.area_mapped_A2);
    CHECK(r.certificate.trusted.by_why[static_cast<std::size_t>(espdiff::Why::kNoPotential)] > 0.05);
    CHECK(r.certificate.trusted.source < 0.9);
  }
}

TEST_SUITE_END();

TEST_CASE("potentials are compared when a closed cavity of the source is removed") {
  Side shell;
  shell.molecule.name = "shell.pqr";
  shell.molecule.residues = {{"SHL", "A", 1, ' '}};
  for (int i = 0; i < 400; ++i) {  // points of a Fibonacci lattice on a sphere
    const double z = 1 - (2 * i + 1) / 400.0, r = std::sqrt(1 - z * z), phi = i * 2.399963229728653;
    espdiff::Atom atom;
    atom.name = "C" + std::to_string(i);
    atom.element = "C";
    shell.molecule.atoms.push_back(atom);
    shell.molecule.positions.push_back(11.0 * Vec3d{r * std::cos(phi), r * std::sin(phi), z});
    shell.molecule.radii.push_back(1.7F);
    shell.molecule.charges.push_back(i % 40 == 0 ? 1.0F : 0.0F);
  }
  Side wider = shell;
  for (Vec3d& p : wider.molecule.positions) p = 1.02 * p;
  shell.map = potential_map(shell.molecule, 1.5);
  wider.map = potential_map(wider.molecule, 1.5);
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  CompareOptions options;
  options.align = espdiff::AlignAtoms::kNone;
  const CompareResult r = compare(*engine, shell.input(), wider.input(), options, {});
  CHECK(r.source_surface.n_cavities_left_out == 1);
  CHECK(r.potential.metrics.area_A2 > 0.9 * r.source_surface.area_A2);
  CHECK(r.potential.metrics.mean_abs_difference > 0);
}
