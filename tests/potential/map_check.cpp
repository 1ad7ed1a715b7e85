// map_check.cpp: given maps of every kind are told by regression on the potentials of the molecule's charges, and
// errors planted into them are named.
#include "input_checks/map_check.h"

#include <memory>
#include <string>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "compare/compare.h"
#include "input_checks/map_warnings.h"
#include "io/structures/structure_file.h"
#include "mapping/build_surface.h"
#include "mapping/input.h"
#include "options/options.h"
#include "potential/cpu_engine.h"
#include "potential/potential_series.h"
#include "report/sections/potential_json.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::MapCheck;
using espdiff::Molecule;
using espdiff::PotentialMethod;
using espdiff::PotentialOptions;
using espdiff::PotentialUnit;
using espdiff::ReferenceKind;
using espdiff::Vec3d;
using espdiff::Warning;

namespace {

constexpr double kRoom_K = 300;

/// A ball of 8 x 8 x 8 places, 2.6 A apart, with whole charges on every fifth atom.
Molecule ball(std::uint64_t seed) {
  Random random(seed);
  Molecule m;
  m.name = "ball";
  for (int i = 0; i < 512; ++i) {
    const Vec3d p{2.6 * (i % 8 - 3.5), 2.6 * (i / 8 % 8 - 3.5), 2.6 * (i / 64 - 3.5)};
    if (espdiff::norm(p) > 10) continue;
    const auto n = static_cast<std::int32_t>(m.residues.size());
    m.residues.push_back({"ALA", "A", n + 1, ' '});
    m.atoms.push_back({"CA", "C", n, false});
    m.positions.push_back(p);
    m.radii.push_back(1.8F);
    m.charges.push_back(n % 5 == 0 ? (random.uniform() < 0.5 ? -1.0F : 1.0F) : 0.0F);
  }
  return m;
}

struct Checked {
  std::shared_ptr<const MapCheck> check;
  std::string text;  ///< of the warnings
  bool refuses = false;
};

/// A molecule with its references.
struct Reference {
  std::unique_ptr<espdiff::Engine> engine = cpu(1);
  Molecule molecule;
  std::unique_ptr<espdiff::MapReferences> references;

  explicit Reference(Molecule of) : molecule(std::move(of)) {
    std::vector<std::pair<std::string, double>> times;
    espdiff::StageClock clock(times);
    const espdiff::RigidTransform to_common = espdiff::principal_frame(molecule.positions);
    const espdiff::Surface surface = espdiff::build_surface(*engine, molecule, to_common, {}, {}, clock);
    references = std::make_unique<espdiff::MapReferences>(*engine, molecule, to_common, surface, 0.5F, kRoom_K,
                                                          espdiff::Progress());
  }

  Grid map(
      PotentialMethod method, const std::function<void(PotentialOptions&)>& change = [](auto&) {}) const {
    PotentialOptions options;
    options.method = method;
    options.pb_spacing_A = 1;
    change(options);
    return espdiff::potential_map(*engine, molecule, options, {});
  }

  Checked check(const Grid& map) const {
    Checked result;
    for (const Warning& w : espdiff::map_warnings("source", map, *references, kRoom_K, result.check)) {
      result.text += w.text.plain() + "\n";
      result.refuses = result.refuses || w.refuses;
    }
    return result;
  }
};

Grid times(Grid map, double factor) {
  for (float& value : map.values) value *= static_cast<float>(factor);
  return map;
}

bool has(const Checked& checked, const std::string& text) { return checked.text.find(text) != std::string::npos; }

}  // namespace

TEST_SUITE_BEGIN("map check");

TEST_CASE("a right map of each kind is told by its shape and its slope") {
  if (!can_run()) return;
  const Reference a(ball(1));
  const auto kind_of = [&](const Grid& map) {
    const Checked c = a.check(map);
    REQUIRE(c.check);
    CAPTURE(c.text);
    CHECK_FALSE(c.refuses);
    CHECK(c.check->best().correlation > 0.95);
    return c.check->kind;
  };
  CHECK(kind_of(a.map(PotentialMethod::kPoissonBoltzmann)) == ReferenceKind::kSolvent);
  CHECK(kind_of(a.map(PotentialMethod::kPoissonBoltzmann, [](auto& o) { o.pb_spacing_A = 2; })) ==
        ReferenceKind::kSolvent);
  CHECK(kind_of(a.map(PotentialMethod::kPoissonBoltzmann, [](auto& o) { o.pb.ionic_strength = 0; })) ==
        ReferenceKind::kSolvent);
  CHECK(kind_of(a.map(PotentialMethod::kCoulomb)) == ReferenceKind::kVacuum);
  CHECK(kind_of(a.map(PotentialMethod::kCoulomb, [](auto& o) { o.coulomb.distance_dependent = true; })) ==
        ReferenceKind::kDistanceDependent);
  CHECK(kind_of(a.map(PotentialMethod::kPme)) == ReferenceKind::kSmoothVacuum);
  CHECK(kind_of(a.map(PotentialMethod::kPme, [](auto& o) { o.grid.resolution_A = 2; })) ==
        ReferenceKind::kSmoothVacuum);
  CHECK(kind_of(a.map(PotentialMethod::kPme, [](auto& o) {
          o.pme.compatible = true;
          o.pme.order = 4;
        })) == ReferenceKind::kSmoothVacuum);
  CHECK(a.check(a.map(PotentialMethod::kCoulomb, [](auto& o) { o.coulomb.dielectric = 4; })).text.empty());
}

TEST_CASE("a map of another unit, sign, place, molecule or quantity is named") {
  if (!can_run()) return;
  const Reference a(ball(1)), b(ball(2));
  const Grid right = a.map(PotentialMethod::kPoissonBoltzmann);
  CHECK(a.check(right).text.empty());
  for (const auto& [factor, unit] : {std::pair(25.85, "mV"), std::pair(0.02585, "V"), std::pair(25.85, "mV")}) {
    const Checked c = a.check(times(right, factor));
    CAPTURE(c.text);
    CHECK(c.refuses);
    CHECK(has(c, std::string("its values are in ") + unit + ", not in kT/e; give source-map-unit " + unit));
  }
  const Checked kcal = a.check(times(right, 0.596));
  CHECK_FALSE(kcal.refuses);
  CHECK_MESSAGE(has(kcal, "its unit is kcal/(mol e) instead of kT/e, or salt and dielectrics"), kcal.text);
  Grid unknown = right;
  unknown.unit = PotentialUnit::kUnknown;
  CHECK_FALSE(a.check(unknown).refuses);
  CHECK_MESSAGE(has(a.check(unknown), "the map of the source has no unit; it is "), a.check(unknown).text);
  CHECK(has(a.check(unknown), "which fits kT/e or kcal/(mol e)"));
  CHECK(has(a.check(times(unknown, 0.1)), "has no unit, and none fits"));
  for (const double factor : {0.1, 10.0}) {
    CHECK(a.check(times(right, factor)).refuses);
    CHECK(has(a.check(times(right, factor)), "no unit makes it kT/e"));
  }
  CHECK(has(a.check(times(right, -1)), "has its sign turned"));
  Grid shifted = right;
  shifted.lattice.origin += Vec3d{3, 0, 0};
  const Grid nothing = times(right, 0);
  for (const Grid& wrong : {shifted, b.map(PotentialMethod::kPoissonBoltzmann), nothing}) {
    const Checked c = a.check(wrong);
    CAPTURE(c.text);
    CHECK(c.refuses);
    CHECK(has(c, "does not belong to it: near the surface it correlates by "));
    CHECK(has(c, "(limit 0.93)"));
    CHECK(has(c, "trust-maps takes it as it is"));
  }
}

TEST_CASE("a map whose title is of another quantity or unit is named, and refused where its values cannot be checked") {
  if (!can_run()) return;
  Molecule few = ball(1);
  const Reference whole(few);
  Grid map = whole.map(PotentialMethod::kPoissonBoltzmann);
  map.name = "a.dx";
  map.contradicting_title = "CHARGE DENSITY (e/A^3)";
  const Checked checked = whole.check(map);
  CHECK_FALSE(checked.refuses);
  CHECK_MESSAGE(has(checked,
                    "the map of the source (a.dx) calls itself 'CHARGE DENSITY (e/A^3)', but is taken as a "
                    "potential in kT/e; make sure of it"),
                checked.text);
  for (std::size_t i = 60; i < few.size(); ++i) few.charges[i] = 0;
  const Checked unchecked = Reference(few).check(map);
  CHECK(unchecked.refuses);
  CHECK_MESSAGE(has(unchecked, "which cannot be checked; give the map of the potential"), unchecked.text);
}

TEST_CASE("a molecule without enough charges, and a map that misses it, are not checked") {
  if (!can_run()) return;
  Molecule few = ball(1);
  const Reference whole(few);
  for (std::size_t i = 60; i < few.size(); ++i) few.charges[i] = 0;
  const Reference a(few);
  CHECK_FALSE(a.check(whole.map(PotentialMethod::kCoulomb)).check);
  Grid away = whole.map(PotentialMethod::kCoulomb);
  away.lattice.origin += Vec3d{100, 0, 0};
  CHECK_FALSE(whole.check(away).check);
}

namespace {

/// A pair of one protein at two pH, with maps of one kind each.
espdiff::CompareResult compared(const Reference& a, const Reference& b, const Grid& of_a, const Grid& of_b,
                                bool trust = false) {
  espdiff::CompareOptions options;
  options.trust_maps = trust;
  return espdiff::compare(*a.engine, {&a.molecule, &of_a}, {&b.molecule, &of_b}, options, {});
}

bool warns(const espdiff::CompareResult& result, const std::string& text) {
  for (const Warning& w : result.inputs.warnings) {
    if (w.text.plain().find(text) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("PMEPot's maps are trustworthy, in vacuum; two kinds are refused, and one map for two states") {
  const auto first = real_input("pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr"),
             second = real_input("pqr_pdb2pqr/1AJJ_pH2_AMBER.pqr");
  if (!first || !second || !can_run()) return;
  const Reference a(espdiff::read_structure(*first, {})), b(espdiff::read_structure(*second, {}));
  const auto as_pmepot = [](PotentialOptions& o) {
    o.pme.compatible = true;
    o.pme.order = 4;
  };
  const Grid pme_a = a.map(PotentialMethod::kPme, as_pmepot), pme_b = b.map(PotentialMethod::kPme, as_pmepot),
             pb_a = a.map(PotentialMethod::kPoissonBoltzmann), pb_b = b.map(PotentialMethod::kPoissonBoltzmann);
  const espdiff::CompareResult pmepot = compared(a, b, pme_a, pme_b), water = compared(a, b, pb_a, pb_b);
  CHECK(pmepot.certificate.trustworthy);
  CHECK(potential_unit_text(pmepot) == "kT/e in vacuum");
  CHECK(potential_label(pmepot) == "given map in vacuum, smooth part");
  CHECK(water.certificate.trustworthy);
  CHECK(potential_unit_text(water) == "kT/e");
  const std::string kinds =
      "two kinds of potential are compared: the source's is given map as in salt water, the target's "
      "given map in vacuum, smooth part";
  CHECK(message_of([&] { compared(a, b, pb_a, pme_b); }) ==
        kinds +
            "; one in vacuum is tens of times one in salt water: compute both alike, or compare them as they are by "
            "trust-maps");
  const espdiff::CompareResult mixed = compared(a, b, pb_a, pme_b, true);
  CHECK(warns(mixed, kinds + ": one in vacuum is tens of times one in salt water"));
  CHECK_FALSE(compared(a, b, pb_a, pb_a).certificate.trustworthy);
  CHECK(warns(compared(a, b, pb_a, pb_a), "one map is given for two different states"));
  const espdiff::CompareResult trusted = compared(a, b, pb_a, pb_a, true);
  CHECK(trusted.certificate.trustworthy);
  CHECK(warns(trusted, "one map is given for two different states"));
  CHECK(compared(a, a, pb_a, pb_a).certificate.trustworthy);
}

TEST_CASE("a map of Coulomb's law in a dielectric is not taken for one in vacuum") {
  if (!can_run()) return;
  const Reference a(ball(1)), b(ball(2));
  const Grid pb = b.map(PotentialMethod::kPoissonBoltzmann);
  for (const double dielectric : {1.0, 78.0}) {
    const Grid map = a.map(PotentialMethod::kCoulomb, [&](auto& o) { o.coulomb.dielectric = dielectric; });
    const std::string message = message_of([&] { compared(a, b, map, pb); });
    CHECK((message.find("two kinds of potential are compared") == 0) == (dielectric == 1));
  }
}

TEST_SUITE_END();
