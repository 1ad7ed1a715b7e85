// invariance.cpp: computed potentials of real molecules do not depend on how these lie in their files.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "certificate/result.h"
#include "compare/compare.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/select_engine.h"
#include "io/structures/structure_file.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "potential/computed_map.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::CompareInput;
using espdiff::CompareOptions;
using espdiff::CompareResult;
using espdiff::ComputedMap;
using espdiff::Molecule;
using espdiff::PotentialMethod;
using espdiff::PotentialOptions;

namespace {

/// Small and larger proteins with charges of -3 to +8 e.
const char* const kMolecules[] = {"pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr", "ubq/ubq.pqr", "series19_ubq_2k39/m07.pqr",
                                  "pair_t4l_maps/3lzm.pqr", "pair_tim_maps/dTIM_chainA.pqr"};
const std::pair<const char*, const char*> kPairs[] = {{"series19_ubq_2k39/m00.pqr", "series19_ubq_2k39/m07.pqr"},
                                                      {"pair_t4l_maps/3lzm.pqr", "pair_t4l_maps/181l_fit.pqr"}};
const PotentialMethod kMethods[] = {PotentialMethod::kPme, PotentialMethod::kCoulomb,
                                    PotentialMethod::kPoissonBoltzmann};

PotentialOptions options_of(PotentialMethod method) {
  PotentialOptions options;
  options.method = method;
  options.pme.part = espdiff::PmePart::kFull;
  options.pb_spacing_A = 1;  // what is tested does not depend on it, and time does
  return options;
}

Molecule turned(Molecule molecule, std::uint64_t seed) {
  Random random(seed);
  const espdiff::RigidTransform turn = random_rigid(random, 40);
  for (Vec3d& p : molecule.positions) p = turn.apply(p);
  return molecule;
}

CompareResult compared(espdiff::Engine& engine, const Molecule& a, const Molecule& b, const PotentialOptions& options) {
  const ComputedMap source(a, {}, options), target(b, {}, options);
  CompareOptions quick;
  quick.surface.grid_spacing_A = 1.5;
  return compare(engine, {&a, nullptr, source.maker()}, {&b, nullptr, target.maker()}, quick, {});
}

double rms_of(const std::vector<float>& values) {
  double sum = 0, n = 0;
  for (const float v : values) {
    if (!std::isfinite(v)) continue;
    sum += static_cast<double>(v) * static_cast<double>(v);
    n += 1;
  }
  return std::sqrt(sum / n);
}

}  // namespace

TEST_SUITE_BEGIN("invariance");

TEST_CASE("a molecule differs from its own copy, rigidly turned, by less than 1 % of the rms potential") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  std::uint64_t seed = 71;
  for (const char* const name : kMolecules) {
    const auto path = real_input(name);
    if (!path) return;
    const Molecule molecule = espdiff::read_structure(*path, {});
    for (const PotentialMethod method : kMethods) {
      const CompareResult result = compared(*engine, molecule, turned(molecule, ++seed), options_of(method));
      const double rms = rms_of(result.surface.potential_source);
      MESSAGE(std::string(name), ", ", to_string(method), ": ", result.potential.metrics.mean_abs_difference, " of ",
              rms, " kT/e");
      CAPTURE(name);
      CHECK(result.potential.metrics.rms_difference < 0.01 * rms);
      CHECK(std::fabs(result.potential.metrics.mean_signed_difference) < 0.01 * rms);
    }
  }
}

TEST_CASE("turning source or target in its file changes no metric by more than 1 %") {
  const auto engine = espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2);
  for (const auto& pair : kPairs) {
    const auto source_path = real_input(pair.first), target_path = real_input(pair.second);
    if (!source_path || !target_path) return;
    const Molecule source = espdiff::read_structure(*source_path, {}),
                   target = espdiff::read_structure(*target_path, {});
    for (const PotentialMethod method : kMethods) {
      const PotentialOptions options = options_of(method);
      const espdiff::Metrics plain = compared(*engine, source, target, options).potential.metrics;
      for (const bool of_source : {true, false}) {
        const CompareResult other = of_source ? compared(*engine, turned(source, 91), target, options)
                                              : compared(*engine, source, turned(target, 92), options);
        const espdiff::Metrics& m = other.potential.metrics;
        CAPTURE(pair.first);
        CAPTURE(to_string(method));
        CAPTURE(of_source);
        CHECK(m.mean_abs_difference == doctest::Approx(plain.mean_abs_difference).epsilon(0.01));
        CHECK(m.rms_difference == doctest::Approx(plain.rms_difference).epsilon(0.01));
        CHECK(std::fabs(m.mean_signed_difference - plain.mean_signed_difference) < 0.01 * plain.mean_abs_difference);
        CHECK(std::fabs(m.sign_change_area_fraction - plain.sign_change_area_fraction) < 0.01);
        CHECK(std::fabs(m.hodgkin_index - plain.hodgkin_index) < 0.01);
        CHECK(std::fabs(m.carbo_index - plain.carbo_index) < 0.01);
        CHECK(m.mean_displacement_A == doctest::Approx(plain.mean_displacement_A).epsilon(0.01));
      }
    }
  }
}

TEST_SUITE_END();
