// map_warnings.cpp: limits of the maps' regression, and the words for what exceeds them.
#include "input_checks/map_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/text/short_numbers.h"
#include "input_checks/map_check.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"

namespace espdiff {
namespace {

/// An exchanged map fits the other molecule better by at least this.
constexpr double kBetterByExchange = 0.02;
/// How far the lattice takes a slope in vacuum from 1.
constexpr double kVacuumFactor = 1.25;
/// A slope this near to 1 needs no comment.
constexpr double kUsualFactor = 1.4;
constexpr double kLargestDielectric = 90;
/// Slopes of the two maps that differ by more: two kinds of salt or dielectric.
constexpr double kSameSettings = 1.3;

constexpr PotentialUnit kNamedUnits[] = {PotentialUnit::kKtPerE,    PotentialUnit::kMillivolt,
                                         PotentialUnit::kVolt,      PotentialUnit::kKcalPerMolE,
                                         PotentialUnit::kKjPerMolE, PotentialUnit::kHartreePerE};

/// Whether two positive numbers differ by at most a factor.
bool within_factor(double a, double b, double factor) { return a > 0 && b > 0 && a < factor * b && b < factor * a; }

double tolerance_of(const MapCheck& check) {
  return check.kind == ReferenceKind::kSolvent ? kSolventFactor : kVacuumFactor;
}

/// Coulomb's law in a dielectric is as good as in vacuum; with a distance-dependent one the slope has one too.
bool is_dielectric(const MapCheck& check) {
  const bool coulomb = check.kind == ReferenceKind::kVacuum || check.kind == ReferenceKind::kDistanceDependent;
  return coulomb && check.best().slope < kVacuumFactor && check.best().slope > 1 / kLargestDielectric;
}

/// The units that a map's values may be in: all that its slope allows, "mV" or "kT/e or kcal/(mol e)"; empty for none.
/// @param factor by which the slope is too large
std::string fitting_units(PotentialUnit declared, const MapCheck& check, double factor, double temperature_K) {
  std::string units;
  const double to_kt =
      declared == PotentialUnit::kUnknown ? 1 : conversion_factor(declared, PotentialUnit::kKtPerE, temperature_K);
  for (const PotentialUnit unit : kNamedUnits) {
    const double expected = to_kt * conversion_factor(PotentialUnit::kKtPerE, unit, temperature_K);
    if (unit == declared || !within_factor(check.best().slope, expected, factor)) continue;
    units += (units.empty() ? "" : " or ") + to_string(unit);
  }
  return units;
}

std::string the_map(const char* role) { return std::string("the map of the ") + role; }

/// "0.13 times the potential of the source's charges in salt water"
std::string as_multiple(const char* role, const MapCheck& check) {
  return short_number(check.best().slope) + " times the potential of the " + role + "'s charges in " +
         to_string(check.kind);
}

Warning refuse(const Message& text) { return {text + "; " + switched_on("trust-maps") + " takes it as it is", true}; }

/// What the slope says of a map that belongs to its molecule.
void judge_slope(const char* role, const Grid& map, const MapCheck& check, double temperature_K,
                 std::vector<Warning>& warnings) {
  const std::string unit_option = std::string(role) + "-map-unit";
  const double slope = check.best().slope, factor = tolerance_of(check);
  if (map.unit == PotentialUnit::kUnknown) {
    const std::string units = fitting_units(map.unit, check, factor, temperature_K);
    if (units.empty() && !is_dielectric(check))
      warnings.push_back(refuse(the_map(role) + " has no unit, and none fits: it is " + as_multiple(role, check) +
                                " in kT/e; give the map of these charges, and its unit by " + option(unit_option)));
    else
      warnings.push_back({the_map(role) + " has no unit; it is " + as_multiple(role, check) + " in kT/e" +
                              (units.empty() ? std::string() : ", which fits " + units) + ": name it by " +
                              option(unit_option),
                          false});
    return;
  }
  const std::string units = fitting_units(map.unit, check, kVacuumFactor, temperature_K);
  if (within_factor(slope, 1, factor) || (is_dielectric(check) && units.empty())) {
    if (!within_factor(slope, 1, kUsualFactor) && !is_dielectric(check))
      warnings.push_back({the_map(role) + " is " + as_multiple(role, check) + " at 0.15 mol/l" +
                              (units.empty() ? ": other salt or dielectrics than usual"
                                             : ": its unit is " + units + " instead of " + to_string(map.unit) +
                                                   ", or salt and dielectrics are not the usual ones; make sure of it"),
                          false});
    return;
  }
  const std::string other = fitting_units(map.unit, check, std::min(factor, 1.6), temperature_K);
  warnings.push_back(
      refuse(the_map(role) + " is " + as_multiple(role, check) + ": " +
             (other.empty() ? Message("no unit makes it " + to_string(map.unit) + "; give the map of these charges")
                            : "its values are in " + other + ", not in " + to_string(map.unit) + "; give " +
                                  option(unit_option, other))));
}

/// A title that names another quantity or unit. It refuses where nothing else can tell whether the values are right.
Warning title_warning(const char* role, const Grid& map, bool is_checked) {
  const std::string unit = map.unit == PotentialUnit::kUnknown ? "" : " in " + to_string(map.unit);
  const Message text = the_map(role) + " (" + map.name + ") calls itself '" + map.contradicting_title +
                       "', but is taken as a potential" + unit;
  if (is_checked) return {text + "; make sure of it", false};
  return refuse(text + ", which cannot be checked; give the map of the potential");
}

bool same_map(const Grid& a, const Grid& b) {
  const Lattice &p = a.lattice, &q = b.lattice;
  const auto near = [](const Vec3d& u, const Vec3d& v) { return norm(u - v) < 1e-6; };
  return p.size == q.size && near(p.origin, q.origin) && near(p.step[0], q.step[0]) && near(p.step[1], q.step[1]) &&
         near(p.step[2], q.step[2]) && a.values == b.values;
}

bool same_state(const Molecule& a, const Molecule& b) {
  constexpr double kSameAtom_A = 0.01;
  const auto same = [](const Vec3d& u, const Vec3d& v) { return norm(u - v) < kSameAtom_A; };
  return std::equal(a.positions.begin(), a.positions.end(), b.positions.begin(), b.positions.end(), same) &&
         a.charges == b.charges;
}

}  // namespace

std::vector<Warning> map_warnings(const char* role, const Grid& map, const MapReferences& references,
                                  double temperature_K, std::shared_ptr<const MapCheck>& result) {
  result.reset();
  const std::optional<MapCheck> check = references.check(map);
  std::vector<Warning> warnings;
  if (!map.contradicting_title.empty()) warnings.push_back(title_warning(role, map, check.has_value()));
  if (!check) return warnings;
  result = std::make_shared<const MapCheck>(*check);
  const double correlation = check->best().correlation;
  if (correlation <= -kLeastMapCorrelation) {
    warnings.push_back(refuse(the_map(role) + " (" + map.name + ") has its sign turned: near the surface it is " +
                              as_multiple(role, *check) + "; turn it, or the charges"));
  } else if (!(correlation >= kLeastMapCorrelation)) {
    warnings.push_back(refuse(the_map(role) + " (" + map.name + ") does not belong to it: near the surface it " +
                              "correlates by " + number_beside(correlation, kLeastMapCorrelation, 2) +
                              " with the potential of the " + role + "'s charges (limit " +
                              formatted("%.2f", kLeastMapCorrelation) +
                              "); give the potential that was computed for these coordinates (an average with "
                              "explicit water cannot be checked)"));
  } else {
    judge_slope(role, map, *check, temperature_K, warnings);
  }
  return warnings;
}

void pair_warnings(const CompareInput& source, const CompareInput& target, const MapReferences* of_source,
                   const MapReferences* of_target, const ComparedMaps& maps, std::vector<Warning>& warnings) {
  if (same_map(*source.map, *target.map) && !same_state(*source.molecule, *target.molecule)) {
    warnings.push_back(refuse("one map is given for two different states (" + source.map->name + ", " +
                              target.map->name + "): each state has a potential of its own"));
    return;
  }
  if (!maps.source_check || !maps.target_check || of_source == nullptr || of_target == nullptr) return;
  const double a = maps.source_check->best().correlation, b = maps.target_check->best().correlation;
  if (std::min(a, b) >= kLeastMapCorrelation + kBetterByExchange) return;
  const std::optional<MapCheck> at_source = of_source->check(*target.map), at_target = of_target->check(*source.map);
  if (!at_source || !at_target) return;
  const double c = at_target->best().correlation, d = at_source->best().correlation;
  if (!(c > a + kBetterByExchange && d > b + kBetterByExchange)) return;
  warnings = {refuse("the maps are exchanged: the source's fits the target's charges (correlation " +
                     formatted("%.2f", c) + " against " + formatted("%.2f", a) + "), the target's the source's (" +
                     formatted("%.2f", d) + " against " + formatted("%.2f", b) + ")")};
}

namespace {

/// One side's potential in words, and whether it is one in vacuum.
struct Kind {
  std::string words;
  bool known = false, vacuum = false, given = false;
};

/// A given map that does not fit its charges is refused for that, and its kind says nothing.
Kind kind_of(const std::shared_ptr<const MapRecipe>& recipe, const std::shared_ptr<const MapCheck>& check) {
  if (recipe) return {potential_label(*recipe), true, is_vacuum(*recipe), false};
  if (!check || check->best().correlation < kLeastMapCorrelation) return {};
  // Coulomb's law in a dielectric has the shape of one in vacuum.
  constexpr double kLeastVacuum = 0.5;
  return {in_words(*check), true, check->is_vacuum() && check->best().slope > kLeastVacuum, true};
}

/// Of source and target.
std::pair<Kind, Kind> kinds_of(const ComparedMaps& maps) {
  return {kind_of(maps.source_recipe, maps.source_check), kind_of(maps.target_recipe, maps.target_check)};
}

Message two_kinds(const Kind& source, const Kind& target) {
  return "two kinds of potential are compared: the source's is " + source.words + ", the target's " + target.words;
}

bool is_vacuum_against_solvent(const Kind& source, const Kind& target) {
  return source.known && target.known && source.vacuum != target.vacuum;
}

bool is_water_of_a_frame(const std::shared_ptr<const MapRecipe>& recipe) {
  return recipe && recipe->method == PotentialMethod::kPme && recipe->has_water && recipe->n_frames == 1;
}

}  // namespace

void refuse_vacuum_against_solvent(const ComparedMaps& maps) {
  const auto [a, b] = kinds_of(maps);
  if (is_vacuum_against_solvent(a, b))
    throw InputError(two_kinds(a, b) +
                     "; one in vacuum is tens of times one in salt water: compute both alike, or compare them as they "
                     "are by " +
                     switched_on("trust-maps"));
}

void refuse_other_kind(const std::string& name_of_first, const std::shared_ptr<const MapCheck>& first,
                       const std::shared_ptr<const MapCheck>& other) {
  const Kind a = kind_of(nullptr, first), b = kind_of(nullptr, other);
  if (is_vacuum_against_solvent(a, b))
    throw InputError("its potential is a " + b.words + ", and that of " + name_of_first + " a " + a.words +
                     "; one in vacuum is tens of times one in salt water: give maps of one kind, or take them as they "
                     "are by " +
                     switched_on("trust-maps"));
}

std::vector<Warning> water_warnings(const ComparedMaps& maps) {
  if (!is_water_of_a_frame(maps.source_recipe) && !is_water_of_a_frame(maps.target_recipe)) return {};
  return {
      {"the potential of single frames with explicit water is mostly that of the water that touches the surface at "
       "that moment: take " +
           option("potential", "pb") +
           " of the solute, or means over windows of frames (espdiff potential; in VMD: Average over)",
       true}};
}

std::vector<Warning> kind_warnings(const ComparedMaps& maps) {
  const auto [a, b] = kinds_of(maps);
  if (!a.known || !b.known) return {};
  if (is_vacuum_against_solvent(a, b))
    return {{two_kinds(a, b) + ": one in vacuum is tens of times one in salt water", false}};
  if (a.words != b.words) return {{two_kinds(a, b) + "; their difference is not of the states alone", false}};
  if (!a.given) {
    const std::string differing = differing_parameters(*maps.source_recipe, *maps.target_recipe);
    if (differing.empty()) return {};
    return {{"the two potentials are computed with different parameters (source and target): " + differing +
                 "; their difference is not of the states alone",
             false}};
  }
  const double s = maps.source_check->best().slope, t = maps.target_check->best().slope;
  if (!(s > 0 && t > 0) || within_factor(s, t, kSameSettings)) return {};
  return {{"the two maps are of two sizes: the source's is " + short_number(s) +
               " times the potential of its charges, the target's " + short_number(t) +
               " times; compute both with the same salt, dielectrics and temperature",
           false}};
}

}  // namespace espdiff
