// poisson_boltzmann_properties.cpp: what holds for any Poisson-Boltzmann potential: the same bits, invariance, warm
// starts, the nonlinear equation's limits; and what is refused, in which words.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

#include "cuda/potential/poisson_boltzmann_inputs.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

/// A small protein, 1AJJ at pH 7 where the real inputs are, else a chain of random atoms.
Molecule small_protein() {
  const auto path = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr");
  if (path) return espdiff::read_structure(*path);
  Molecule m;
  Random random(5);
  Vec3d at{};
  for (int i = 0; i < 300; ++i) {
    at = at + 1.3 * random.direction() + (-0.05) * at;
    m.positions.push_back(at);
    m.radii.push_back(static_cast<float>(random.uniform(1.0, 1.9)));
    m.charges.push_back(static_cast<float>(random.uniform(-0.5, 0.5)));
  }
  return m;
}

espdiff::RigidTransform some_motion() {
  espdiff::RigidTransform motion;
  const double a = 0.6, b = 1.1, ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  const double r[9] = {ca, -sa * cb, sa * sb, sa, ca * cb, -ca * sb, 0, sb, cb};
  std::copy(r, r + 9, motion.rotation);
  motion.translation = {3.3, -7.1, 12.9};
  return motion;
}

Molecule moved(Molecule m, const espdiff::RigidTransform& motion) {
  for (Vec3d& p : m.positions) p = motion.apply(p);
  return m;
}

std::string refusal(Engine& engine, const Molecule& m, const Lattice& lattice, const PoissonBoltzmannOptions& options) {
  return message_of([&] { pb_map(engine, m, lattice, options); });
}

}  // namespace

TEST_SUITE_BEGIN("poisson_boltzmann_properties");

TEST_CASE("the same bits for 1, 2 and 4 threads, on repetition, and for any order of the atoms") {
  const Molecule m = small_protein();
  Molecule turned_round = m;
  std::reverse(turned_round.positions.begin(), turned_round.positions.end());
  std::reverse(turned_round.radii.begin(), turned_round.radii.end());
  std::reverse(turned_round.charges.begin(), turned_round.charges.end());
  const Lattice lattice = pb_lattice(m, 0.8, 6);
  for (const bool nonlinear : {false, true}) {
    PoissonBoltzmannOptions options;
    options.nonlinear = nonlinear;
    std::vector<float> first;
    for (const int n_threads : {1, 2, 4}) {
      for (const auto& engine : fast_back_ends(n_threads)) {
        if (engine->back_end() != "cpu") continue;
        for (const Molecule* input : std::initializer_list<const Molecule*>{&m, &turned_round}) {
          const std::vector<float> values = pb_map(*engine, *input, lattice, options).values;
          if (first.empty()) first = values;
          REQUIRE(values.size() == first.size());
          CHECK(std::memcmp(values.data(), first.data(), first.size() * sizeof(float)) == 0);
        }
      }
    }
  }
}

TEST_CASE("back ends agree") {
  const Molecule m = small_protein();
  const Lattice lattice = pb_lattice(m, 2, 5);
  const auto engines = back_ends();
  for (const auto boundary : {espdiff::DielectricBoundary::kMolecular, espdiff::DielectricBoundary::kGaussian}) {
    for (const bool nonlinear : {false, true}) {
      PoissonBoltzmannOptions options;
      options.dielectric_boundary = boundary;
      options.nonlinear = nonlinear;
      options.smoothing = nonlinear ? espdiff::DielectricSmoothing::kNinePoint : espdiff::DielectricSmoothing::kEdges;
      const Grid first = pb_map(*engines[0], m, lattice, options);
      for (std::size_t e = 1; e < engines.size(); ++e)
        CHECK(deviation(pb_map(*engines[e], m, lattice, options).values, first.values).of_rms < 1e-5);
    }
  }
}

TEST_CASE("turning a molecule on the grid changes its surface's potentials by less than 3 % at 0.5 A") {
  const Molecule m = small_protein();
  const espdiff::RigidTransform motion = some_motion();
  const Molecule elsewhere = moved(m, motion);
  for (const auto& engine : fast_back_ends()) {
    const auto surface = comparison_surface(*engine, m);
    const auto straight = engine->sample(pb_on_device(*engine, m, pb_lattice(m, 0.5, 10), {}), surface);
    const auto turned = engine->sample(
        pb_on_device(*engine, elsewhere, pb_lattice(elsewhere, 0.5, 10), {}, nullptr, nullptr, motion), surface);
    const Deviation d = deviation(engine->download(turned), engine->download(straight));
    MESSAGE("turned against straight: ", 100 * d.of_rms, " % of the rms potential, correlation ", d.correlation);
    CHECK(d.of_rms < 0.03);
  }
}

TEST_CASE("turning both molecules of a pair on the grid changes their mean absolute difference by less than 1 %") {
  const auto other_path = real_input("pqr_pdb2pqr/1AJJ_pH2_AMBER.pqr");
  if (!other_path) return;
  const Molecule m = small_protein(), other = espdiff::read_structure(*other_path);
  const espdiff::RigidTransform motion = some_motion();
  for (const auto& engine : fast_back_ends()) {
    const auto surface = comparison_surface(*engine, m);
    const auto difference = [&](const espdiff::RigidTransform& by) {
      const Lattice lattice = pb_lattice(moved(m, by), espdiff::kUsualPbSpacing_A, espdiff::kUsualPbPadding_A);
      const auto on_surface = [&](const Molecule& of) {
        return engine->download(
            engine->sample(pb_on_device(*engine, moved(of, by), lattice, {}, nullptr, nullptr, by), surface));
      };
      return deviation(on_surface(other), on_surface(m)).mean_absolute;
    };
    const double straight = difference({}), turned = difference(motion);
    MESSAGE("mean absolute difference of pH 2 and 7: ", straight, ", turned ", turned);
    CHECK(turned == doctest::Approx(straight).epsilon(0.01));
  }
}

TEST_CASE("a start from the potential of the frame before needs fewer cycles, and gives the same potential") {
  const Molecule m = small_protein();
  Molecule next = m;
  Random random(9);
  for (Vec3d& p : next.positions) p = p + 0.05 * random.direction();
  const Lattice lattice = pb_lattice(m, 0.6, 8);
  PoissonBoltzmannOptions options;
  options.tolerance = 1e-6;
  for (const auto& engine : fast_back_ends()) {
    PoissonBoltzmannReport cold, warm, again;
    const auto before = pb_on_device(*engine, m, lattice, options);
    const Grid from_zero = pb_map(*engine, next, lattice, options, &cold);
    const Grid from_before = engine->download(pb_on_device(*engine, next, lattice, options, &warm, before));
    pb_on_device(*engine, m, lattice, options, &again, before);
    MESSAGE("cycles from zero ", cold.cycles, ", from the frame before ", warm.cycles, ", from itself ", again.cycles);
    CHECK(warm.start_residual < 0.5);
    CHECK(cold.surface_error <= options.tolerance);
    CHECK(warm.cycles < cold.cycles);
    CHECK(again.cycles <= 1);
    CHECK(deviation(from_before.values, from_zero.values).of_rms < 1e-5);
  }
}

TEST_CASE("the error at the surface is below the one that is reported, and that is below the tolerance") {
  const Molecule whole = small_protein();
  Molecule dipoles = whole;  // charges that cancel nearly everywhere
  for (std::size_t i = 0; i < dipoles.charges.size(); ++i) dipoles.charges[i] = i % 2 == 0 ? 0.5F : -0.5F;
  for (const Molecule* m : std::initializer_list<const Molecule*>{&whole, &dipoles}) {
    const Lattice lattice = pb_lattice(*m, 0.7, 8);
    std::vector<std::size_t> near;  // grid points next to the atoms' spheres
    Random random(4);
    for (std::size_t i = 0; i < m->size(); ++i) {
      const Vec3d at = m->positions[i] + (static_cast<double>(m->radii[i]) + 0.7) * random.direction() - lattice.origin;
      const auto step = [&](double along) { return static_cast<std::size_t>(std::lround(along / 0.7)); };
      near.push_back(step(at.x) + static_cast<std::size_t>(lattice.size[0]) *
                                      (step(at.y) + static_cast<std::size_t>(lattice.size[1]) * step(at.z)));
    }
    for (const auto& engine : fast_back_ends()) {
      const auto potential = [&](double tolerance, PoissonBoltzmannReport* report) {
        PoissonBoltzmannOptions options;
        options.tolerance = tolerance;
        const Grid map = pb_map(*engine, *m, lattice, options, report);
        std::vector<float> there;
        for (const std::size_t p : near) there.push_back(map.values[p]);
        return there;
      };
      PoissonBoltzmannReport exact;
      const std::vector<float> converged = potential(1e-9, &exact);
      int cycles = exact.cycles;
      for (const double tolerance : {1e-6, 1e-4, 1e-2}) {
        PoissonBoltzmannReport report;
        const double error = deviation(potential(tolerance, &report), converged).of_rms;
        MESSAGE("asked for ", tolerance, ", reported ", report.surface_error, ", true ", error, ", cycles ",
                report.cycles);
        CHECK(report.surface_error <= tolerance);
        CHECK(error <= report.surface_error);
        CHECK(error > 1e-3 * tolerance);  // no more than needed
        CHECK(report.cycles < cycles);
        cycles = report.cycles;
      }
    }
  }
}

TEST_CASE(
    "6 A of solvent and a wider grid around them are nearer to 24 A than 12 A are, next to the atoms and at 3 A") {
  const Molecule m = small_protein();
  const Lattice lattice = pb_lattice(m, 0.7, 6);
  PoissonBoltzmannOptions by_sum, by_focus;
  by_sum.far_boundary = espdiff::FarBoundary::kDebyeHueckel;
  for (const auto& engine : fast_back_ends()) {
    const auto on_lattice = [&](double padding, const PoissonBoltzmannOptions& options) {
      const Lattice own = pb_lattice(m, 0.7, padding);
      return engine->download(engine->resample(pb_on_device(*engine, m, own, options), lattice));
    };
    const Grid wide = on_lattice(24, by_sum), usual = on_lattice(12, by_sum), focused = on_lattice(6, by_focus);
    for (const double distance : {0.5, 3.0}) {
      std::vector<float> of_wide, of_usual, of_focused;
      for (std::size_t p = 0; p < wide.values.size(); p += 3) {
        double nearest = 1e9;
        for (std::size_t i = 0; i < m.size(); ++i)
          nearest = std::min(nearest, norm(point_of(lattice, p) - m.positions[i]) - static_cast<double>(m.radii[i]));
        if (std::fabs(nearest - distance) > 0.3) continue;
        of_wide.push_back(wide.values[p]);
        of_usual.push_back(usual.values[p]);
        of_focused.push_back(focused.values[p]);
      }
      const double error = deviation(of_focused, of_wide).of_rms, before = deviation(of_usual, of_wide).of_rms;
      MESSAGE(distance, " A outside: ", 100 * error, " % of the rms by 6 A and a wider grid, ", 100 * before,
              " % by 12 A alone");
      CHECK(error < (distance < 1 ? 0.0015 : 0.003));
      CHECK(error < 0.5 * before);
    }
  }
}

TEST_CASE("without a boundary the residual counts") {
  const Molecule ion = molecule_of({{0, 0, 0}}, {2.0F}, {1.0F});
  PoissonBoltzmannOptions options;
  options.solute_dielectric = options.solvent_dielectric;
  for (const auto& engine : fast_back_ends()) {
    PoissonBoltzmannReport report;
    pb_map(*engine, ion, pb_lattice(ion, 0.5, 8), options, &report);
    CHECK(report.relative_residual <= options.tolerance);
    CHECK(report.surface_error <= options.tolerance);
  }
}

TEST_CASE("a start that is worse than none does no harm: strong charges elsewhere, both equations") {
  const Molecule here = molecule_of({{0, 0, 0}}, {2.0F}, {9.0F}), there = molecule_of({{5, 0, 0}}, {2.0F}, {-9.0F});
  const Lattice lattice = pb_lattice(molecule_of({{0, 0, 0}, {5, 0, 0}}, {2.0F, 2.0F}, {1.0F, 1.0F}), 0.6, 8);
  for (const auto& engine : fast_back_ends()) {
    for (const bool nonlinear : {false, true}) {
      PoissonBoltzmannOptions options;
      options.nonlinear = nonlinear;
      PoissonBoltzmannReport cold, warm;
      const Grid from_zero = pb_map(*engine, here, lattice, options, &cold);
      const auto start = pb_on_device(*engine, there, lattice, options);
      const Grid from_there = engine->download(pb_on_device(*engine, here, lattice, options, &warm, start));
      CHECK(warm.start_residual > 1);
      CHECK(warm.cycles == cold.cycles);
      CHECK(warm.surface_error <= options.tolerance);
      CHECK(from_there.values == from_zero.values);
    }
  }
}

TEST_CASE("the nonlinear potential is the linear one's where charges are weak, and weaker where they are strong") {
  for (const auto& engine : fast_back_ends()) {
    const auto both = [&](float charge) {
      const Molecule m = molecule_of({{0, 0, 0}}, {2.0F}, {charge});
      PoissonBoltzmannOptions options;
      const Lattice lattice = pb_lattice(m, 0.5, 12);
      const Grid linear = pb_map(*engine, m, lattice, options);
      options.nonlinear = true;
      PoissonBoltzmannReport report;
      const Grid nonlinear = pb_map(*engine, m, lattice, options, &report);
      CHECK(report.newton_steps > 0);
      double sums[2] = {};
      for (std::size_t p = 0; p < linear.values.size(); ++p) {
        const double r = norm(point_of(lattice, p));
        if (r < 5 || r > 8) continue;
        sums[0] += static_cast<double>(linear.values[p]);
        sums[1] += static_cast<double>(nonlinear.values[p]);
      }
      return sums[1] / sums[0];
    };
    CHECK(both(0.05F) == doctest::Approx(1).epsilon(1e-3));
    CHECK(both(8.0F) < 0.95);
  }
}

TEST_CASE("cancelling ends it") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const Molecule m = small_protein();
  espdiff::Progress* handle = nullptr;
  espdiff::Progress progress([&](const std::string&, double fraction) {
    if (fraction > 0.3) handle->request_cancel();
  });
  handle = &progress;
  CHECK_THROWS_AS(engine->poisson_boltzmann(m.positions, m.radii, m.charges, pb_lattice(m, 0.8, 6), {}, {}, nullptr,
                                            progress, nullptr),
                  espdiff::Cancelled);
}

TEST_CASE("what is refused, and how") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1);
  const Molecule ion = molecule_of({{0, 0, 0}}, {2.0F}, {1.0F});
  const Lattice lattice = pb_lattice(ion, 1.0, 8);
  PoissonBoltzmannOptions options;
  CHECK(refusal(*engine, molecule_of({{0, 0, 0}}, {2.0F}, {0.0F}), lattice, options) ==
        "none of the 1 atoms has a charge; take charges from a topology (PSF, prmtop) or a PQR file");
  CHECK(refusal(*engine, molecule_of({{0, 0, 0}}, {0.0F}, {1.0F}), lattice, options) ==
        "none of the 1 atoms has a radius, so there is no solute; take radii from a PQR file");
  CHECK(refusal(*engine, molecule_of({{0, 0, 0}, {0, 0, 3}}, {2.0F, 0.0F}, {1.0F, 0.5F}), lattice, options) ==
        "atom 2 has a charge of 0.5 and a radius of 0, and lies in no other atom: its charge would be bare in the "
        "solvent; give it a radius");
  CHECK(refusal(*engine, molecule_of({{0, 0, 0}}, {-1.0F}, {1.0F}), lattice, options) ==
        "atom 1 has a radius of -1 A, which is not a number from 0 on");
  CHECK(refusal(*engine, molecule_of({{0, 0, 9.5}}, {2.0F}, {1.0F}), lattice, options) ==
        "atom 1 lies outside the grid, or within 3 A of its border; use a larger padding");
  options.solute_dielectric = 0;
  CHECK(refusal(*engine, ion, lattice, options) == "solute dielectric 0 is not a positive number; 2 is usual");
  options = {};
  options.solvent_dielectric = -78;
  CHECK(refusal(*engine, ion, lattice, options) == "solvent dielectric -78 is not a positive number; 78.54 is water's");
  options = {};
  options.ionic_strength = -0.1;
  CHECK(refusal(*engine, ion, lattice, options) ==
        "ionic strength -0.1 mol/l is not a number from 0 on; 0.15 is usual");
  options = {};
  options.temperature_K = 0;
  CHECK(refusal(*engine, ion, lattice, options) == "temperature 0 K is not a positive number; 300 is usual");
  options = {};
  options.probe_radius_A = -1;
  CHECK(refusal(*engine, ion, lattice, options) == "probe radius -1 A is not a number from 0 on; 1.4 is water's");
  options = {};
  Lattice skewed = lattice;
  skewed.step[1].y = 0.7;
  CHECK(refusal(*engine, ion, skewed, options) ==
        "the Poisson-Boltzmann equation needs a cubic lattice along the axes");
  Lattice huge = lattice;
  huge.size = {2001, 2001, 2001};
  huge.origin = {-1000, -1000, -1000};
  const std::string too_many = refusal(*engine, ion, huge, options);
  CHECK(too_many.find("a grid of 2001 x 2001 x 2001 points needs 385 GB of memory, and ") == 0);
  CHECK(too_many.find(" A would fit") != std::string::npos);
  options.max_cycles = 2;
  CHECK(refusal(*engine, ion, lattice, options)
            .find("the Poisson-Boltzmann equation did not converge: the relative error is ") == 0);
  options = {};
  options.nonlinear = true;
  options.max_newton_steps = 1;
  const std::string no_end = refusal(*engine, molecule_of({{0, 0, 0}}, {2.0F}, {9.0F}), lattice, options);
  CHECK(no_end.find("the nonlinear Poisson-Boltzmann equation did not converge: the relative residual is ") == 0);
  CHECK(no_end.find("use the linearized equation, or a smaller spacing") != std::string::npos);
}

TEST_CASE("the grid around atoms: what it reaches, and what it refuses") {
  const Lattice lattice = espdiff::poisson_boltzmann_lattice({{0, 0, 0}, {10, 0, 0}}, {2.0F, 1.0F}, 0.5, 10);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(lattice.size[axis] % 8 == 1);
    CHECK(lattice.origin[static_cast<int>(axis)] <= -12 + 1e-9);
  }
  CHECK(point_of(lattice, lattice.n_points() - 1).x >= 21 - 1e-9);
  CHECK(message_of([] {
          espdiff::poisson_boltzmann_lattice({{0, 0, 0}}, {1.0F}, 0, 10);
        }) == "grid spacing 0 A is not a positive number; 0.5 is usual");
  CHECK(message_of([] {
          espdiff::poisson_boltzmann_lattice({{0, 0, 0}}, {1.0F}, 0.001, 10);
        }).find("2e9 points") != std::string::npos);
  CHECK(message_of([] { espdiff::poisson_boltzmann_lattice({}, {}, 0.5, 10); }) == "no atoms to lay a grid around");
}

TEST_SUITE_END();
