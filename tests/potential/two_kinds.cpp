// two_kinds.cpp: two kinds of potential in one comparison are refused or warned of, and so is the water of single
// frames.
#include <functional>
#include <string>

#include "base/error.h"
#include "compare/compare.h"
#include "mapping/input.h"
#include "potential/computed_map.h"
#include "potential/cpu_engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::ChargeSurroundings;
using espdiff::PotentialMethod;
using espdiff::PotentialOptions;

namespace {

/// Options of a coarse, quick potential.
PotentialOptions of(
    PotentialMethod method, const std::function<void(PotentialOptions&)>& change = [](auto&) {}) {
  PotentialOptions options;
  options.method = method;
  options.pb_spacing_A = 1;
  change(options);
  return options;
}

CompareInput computed(const Side& side, const PotentialOptions& options, const ChargeSurroundings& around = {}) {
  return {&side.molecule, nullptr, espdiff::ComputedMap(side.molecule, around, options).maker()};
}

const PotentialOptions kPb = of(PotentialMethod::kPoissonBoltzmann), kCoulomb = of(PotentialMethod::kCoulomb);

/// Warnings and reasons, a line each.
std::string said(const CompareResult& result) {
  std::string text;
  for (const espdiff::Warning& warning : result.inputs.warnings)
    text += (warning.refuses ? "refuses: " : "warns: ") + warning.text.plain() + "\n";
  return text;
}

/// Said of a pair of states by these potentials.
std::string said_of(const PotentialOptions& source, const PotentialOptions& target, bool trust_maps = false) {
  const Side a = make_side(1, 0), b = make_side(1, 0.3);
  espdiff::CompareOptions options = quick_options();
  options.trust_maps = trust_maps;
  return said(compare(*cpu(1), computed(a, source), computed(b, target), options, {}));
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_SUITE_BEGIN("two kinds of potential");

TEST_CASE("vacuum against solvent is refused, in either order; whoever insists is warned") {
  if (!can_run()) return;
  CHECK(message_of([] { said_of(kCoulomb, kPb); }) ==
        "two kinds of potential are compared: the source's is vacuum (Coulomb), the target's Poisson-Boltzmann, 0.15 "
        "mol/l; one in vacuum is tens of times one in salt water: compute both alike, or compare them as they are by "
        "trust-maps");
  CHECK(has(message_of([] { said_of(kPb, of(PotentialMethod::kPme)); }),
            "the source's is Poisson-Boltzmann, 0.15 mol/l, the target's vacuum (PME without water"));
  CHECK(has(said_of(kCoulomb, kPb, true), "warns: two kinds of potential are compared: the source's is vacuum"));
}

TEST_CASE("potentials in vacuum, and those in dielectrics, are compared with a warning") {
  if (!can_run()) return;
  CHECK(has(said_of(kCoulomb, of(PotentialMethod::kPme)), "warns: two kinds of potential are compared"));
  CHECK(has(said_of(of(PotentialMethod::kCoulomb, [](auto& o) { o.coulomb.dielectric = 78; }), kPb),
            "warns: two kinds of potential are compared: the source's is Coulomb, dielectric 78"));
}

TEST_CASE("one equation with other parameters is warned of, with both values") {
  if (!can_run()) return;
  const auto salt = of(PotentialMethod::kPoissonBoltzmann, [](auto& o) { o.pb.ionic_strength = 0.05; });
  CHECK(has(said_of(salt, kPb),
            "warns: two kinds of potential are compared: the source's is Poisson-Boltzmann, 0.05 "
            "mol/l, the target's Poisson-Boltzmann, 0.15 mol/l"));
  const auto protein = of(PotentialMethod::kPoissonBoltzmann, [](auto& o) { o.pb.solute_dielectric = 4; });
  CHECK(has(said_of(kPb, protein),
            "warns: the two potentials are computed with different parameters (source and "
            "target): solute dielectric 2 and 4; their difference is not of the states alone"));
  CHECK_FALSE(has(said_of(kPb, kPb), "potentials are computed"));
}

TEST_CASE("PME of single frames with explicit water is never trustworthy") {
  if (!can_run()) return;
  const Side a = make_side(1, 0), b = make_side(1, 0.1);
  const ChargeSurroundings water{espdiff::UnitCell{{60, 60, 60}, {90, 90, 90}}, {}, true},
      vacuum{water.cell, {}, false};
  const PotentialOptions pme = of(PotentialMethod::kPme);
  const auto engine = cpu(1);
  for (const bool trust_maps : {false, true}) {
    espdiff::CompareOptions options = quick_options();
    options.trust_maps = trust_maps;
    const CompareResult wet = compare(*engine, computed(a, pme, water), computed(b, pme, water), options, {}),
                        dry = compare(*engine, computed(a, pme, vacuum), computed(b, pme, vacuum), options, {});
    CHECK_FALSE(wet.certificate.trustworthy);
    const std::string reason =
        "the potential of single frames with explicit water is mostly that of the water that touches the surface at "
        "that moment: take potential pb of the solute, or means over windows of frames (espdiff potential; in VMD: "
        "Average over)";
    CHECK(has(said(wet), "refuses: " + reason));
    CHECK_FALSE(has(said(dry), "explicit water"));
  }
}

TEST_SUITE_END();
