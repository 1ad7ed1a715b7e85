// poisson_boltzmann_apbs.cpp: potentials beside those of APBS with the same definitions on the same grids.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "cuda/potential/apbs_oracle.h"
#include "cuda/potential/poisson_boltzmann_inputs.h"
#include "io/structures/structure_file.h"

using namespace espdiff_test;
using espdiff::DielectricSmoothing;

namespace {

/// APBS' definitions: smoothing over nine points, and the border of its `mdh`.
PoissonBoltzmannOptions apbs_options() {
  PoissonBoltzmannOptions options;
  options.far_boundary = espdiff::FarBoundary::kDebyeHueckel;
  options.smoothing = DielectricSmoothing::kNinePoint;
  return options;
}

/// Says SKIPPED, and why, where APBS or the file is absent.
std::optional<Molecule> oracle_molecule(const std::string& path) {
  if (!apbs_is_there()) {
    MESSAGE("SKIPPED: apbs is not on PATH; Debian's package apbs has it");
    return std::nullopt;
  }
  if (!std::filesystem::exists(path)) {
    MESSAGE("SKIPPED: ", path, " is absent; Debian's package apbs-data has the examples");
    return std::nullopt;
  }
  return espdiff::read_structure(path);
}

std::optional<Molecule> example(const std::string& name) { return oracle_molecule(apbs_examples() + "/" + name); }
std::optional<Molecule> real_molecule(const std::string& name) {
  const auto path = real_input(name);
  return path ? oracle_molecule(*path) : std::nullopt;
}

/// n^3 points around the molecule's middle.
Lattice lattice_of(const Molecule& m, int n, double spacing) {
  Lattice lattice = pb_lattice(m, spacing, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.origin[static_cast<int>(axis)] += 0.5 * spacing * (lattice.size[axis] - n);
    lattice.size[axis] = n;
  }
  return lattice;
}

/// [grid point] whether it lies `from` to `to` Angstrom outside the nearest atom.
std::vector<bool> shell(const Molecule& m, const Lattice& lattice, double from, double to) {
  std::vector<float> gap(lattice.n_points(), 1e9F);
  const double h = lattice.step[0].x;
  for (std::size_t a = 0; a < m.size(); ++a) {
    if (!(m.radii[a] > 0)) continue;
    const double reach = static_cast<double>(m.radii[a]) + to;
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double c = (m.positions[a][axis] - lattice.origin[axis]) / h;
      low[axis] = std::max(0, static_cast<int>(c - reach / h));
      high[axis] = std::min(lattice.size[static_cast<std::size_t>(axis)] - 1, static_cast<int>(c + reach / h) + 1);
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          const std::size_t p =
              static_cast<std::size_t>(i + lattice.size[0] * (j + static_cast<long>(lattice.size[1]) * k));
          gap[p] = std::min(gap[p], static_cast<float>(norm(point_of(lattice, p) - m.positions[a])) - m.radii[a]);
        }
      }
    }
  }
  std::vector<bool> inside(gap.size());
  for (std::size_t p = 0; p < gap.size(); ++p)
    inside[p] = static_cast<double>(gap[p]) >= from && static_cast<double>(gap[p]) <= to;
  return inside;
}

struct ApbsAgreement {
  Deviation outside, surface;
  std::vector<float> ours, theirs;  ///< [vertex]
};

ApbsAgreement agreement(Engine& engine, const Molecule& m, const Lattice& lattice,
                        const PoissonBoltzmannOptions& options, const espdiff::MeshPtr& surface) {
  const ScratchFolder folder;
  const Grid apbs = apbs_map(folder, m, lattice, options);
  PoissonBoltzmannReport report;
  const auto on_device = pb_on_device(engine, m, lattice, options, &report);
  const Grid own = engine.download(on_device);
  REQUIRE(apbs.values.size() == own.values.size());
  const std::vector<bool> counts = shell(m, lattice, 1.4, 6);
  std::vector<float> a, b;
  for (std::size_t p = 0; p < counts.size(); ++p) {
    if (!counts[p]) continue;
    a.push_back(own.values[p]);
    b.push_back(apbs.values[p]);
  }
  ApbsAgreement result;
  result.outside = deviation(a, b);
  result.ours = engine.download(engine.sample(on_device, surface));
  result.theirs = engine.download(engine.sample(engine.upload_map(apbs, {}), surface));
  result.surface = deviation(result.ours, result.theirs);
  MESSAGE(lattice.size[0], "^3 at ", lattice.step[0].x, " A, ", report.cycles, " cycles: 1.4 to 6 A outside ",
          100 * result.outside.of_rms, " % of the rms, correlation ", result.outside.correlation, "; on the surface ",
          100 * result.surface.of_rms, " %");
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("poisson_boltzmann_apbs");

TEST_CASE("FKBP: within 1 % of APBS' potential outside, and on the surface") {
  const auto m = example("FKBP/1d7h-min.pqr");
  if (!m) return;
  for (const auto& engine : fast_back_ends()) {
    const ApbsAgreement found =
        agreement(*engine, *m, lattice_of(*m, 97, 0.7), apbs_options(), comparison_surface(*engine, *m));
    CHECK(found.outside.of_rms < 0.01);
    CHECK(found.outside.correlation > 0.9999);
    CHECK(found.surface.of_rms < 0.05);
  }
}

TEST_CASE("1AJJ: on the surface within 5 % at 0.5 A, and nearer at 0.3 A; the difference between two pH within 2 %") {
  const auto m = real_molecule("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr"),
             other = real_molecule("pqr_pdb2pqr/1AJJ_pH2_AMBER.pqr");
  if (!m || !other) return;
  for (const auto& engine : fast_back_ends()) {
    const auto surface = comparison_surface(*engine, *m);
    const Lattice lattice = lattice_of(*m, 97, 0.5);
    const ApbsAgreement coarse = agreement(*engine, *m, lattice, apbs_options(), surface);
    CHECK(coarse.outside.of_rms < 0.01);
    CHECK(coarse.outside.correlation > 0.9999);
    CHECK(coarse.surface.of_rms < 0.05);
    const ApbsAgreement second = agreement(*engine, *other, lattice, apbs_options(), surface);
    const double ours = deviation(second.ours, coarse.ours).mean_absolute,
                 theirs = deviation(second.theirs, coarse.theirs).mean_absolute;
    MESSAGE("mean absolute difference of pH 2 and 7: ", ours, ", APBS ", theirs);
    CHECK(ours == doctest::Approx(theirs).epsilon(0.02));
    const ApbsAgreement fine = agreement(*engine, *m, lattice_of(*m, 129, 0.3), apbs_options(), surface);
    CHECK(fine.surface.of_rms < coarse.surface.of_rms);
  }
}

TEST_CASE("ASP66 charged or not in lysozyme: the mean absolute difference within 2 % of APBS'") {
  const auto charged = example("bem-pKa/test_proteins/2LZT-ASP66.pqr"),
             neutral = example("bem-pKa/test_proteins/2LZT-ASH66.pqr");
  if (!charged || !neutral) return;
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 0);
  const auto surface = comparison_surface(*engine, *charged);
  const Lattice lattice = lattice_of(*charged, 97, 0.65);
  const ApbsAgreement a = agreement(*engine, *charged, lattice, apbs_options(), surface),
                      b = agreement(*engine, *neutral, lattice, apbs_options(), surface);
  const double ours = deviation(a.ours, b.ours).mean_absolute, theirs = deviation(a.theirs, b.theirs).mean_absolute;
  MESSAGE("mean absolute difference: ", ours, ", APBS ", theirs);
  CHECK(ours == doctest::Approx(theirs).epsilon(0.02));
}

TEST_CASE("the nonlinear equation on DNA: within 1 % of APBS' npbe outside") {
  const auto m = example("bem-binding-energy/test_proteins/1d30.pqr");
  if (!m) return;
  for (const auto& engine : fast_back_ends()) {
    PoissonBoltzmannOptions options = apbs_options();
    options.nonlinear = true;
    const auto surface = comparison_surface(*engine, *m);
    const Lattice lattice = lattice_of(*m, 97, 0.6);
    const ApbsAgreement found = agreement(*engine, *m, lattice, options, surface);
    CHECK(found.outside.of_rms < 0.01);
    CHECK(found.outside.correlation > 0.9999);
    CHECK(found.surface.of_rms < 0.05);
    // The linear equation is far from it there.
    options.nonlinear = false;
    const auto linear = engine->download(engine->sample(pb_on_device(*engine, *m, lattice, options), surface));
    CHECK(deviation(linear, found.theirs).of_rms > 0.1);
  }
}

TEST_SUITE_END();
