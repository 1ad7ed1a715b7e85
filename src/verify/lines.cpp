// lines.cpp: recorded numbers beside recomputed ones, and the names of what has no such number.
#include "verify/lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace espdiff {
namespace {

/// Sums in single precision against sums in double precision.
constexpr double kRelative = 2e-4;

constexpr const char* kWords = "words, which no other file has";
constexpr const char* kHow = "how it was computed";
/// What a result holds besides what can be computed from its files.
constexpr struct {
  const char* name;
  const char* why;
} kNotRecomputed[] = {{"options", kHow},
                      {"command_line", kHow},
                      {"time_ms", kHow},
                      {"device", kHow},
                      {"device_description", kHow},
                      {"threads", kHow},
                      {"iterations", kHow},
                      {"iterations_regularize", kHow},
                      {"start", kHow},
                      {"n_vertices_added", kHow},
                      {"inputs", "how inputs are called and were read, and computed potentials, which are in no file"},
                      {"names", kWords},
                      {"notes", kWords},
                      {"shapes_because", kWords},
                      {"warnings", kWords},
                      {"certificate/reasons", kWords},
                      {"certificate/not_checked", kWords},
                      {"certificate/untrusted_parts", kWords},
                      {"certificate/turned_side_chains/residues", kWords},
                      {"whole_surface", "an estimate from the residues' own surfaces"},
                      {"certificate/zero_by_construction", kWords},
                      {"certificate/round_trip", "the mapping back is in no file"},
                      {"certificate/converged", "the iteration is in no file"},
                      {"by_offset", "potentials outside of the surface, and what lies inside of atoms, are in no file"},
                      {"region", "which triangles belong to it is in no file"},
                      {"fixed_patches", "which triangles belong to it is in no file"},
                      {"causes", "words, and readings of potentials, which are in no file"},
                      {"given_maps", "the potentials that maps are compared with are in no file"},
                      {"superposition/domains", "the domains' motions are in no file"},
                      {"motions", "the domains' motions are in no file"},
                      {"surfaces", "the surfaces before the mapping are in no file"},
                      {"OUT.residues.csv", "the surfaces before the mapping are in no file"}};

/// "a", "a/b" and "a/b/c" of "a/b/c".
std::vector<std::string> places_on_the_way(const std::string& name) {
  std::vector<std::string> places;
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1))
    places.push_back(name.substr(0, at));
  places.push_back(name);
  return places;
}

}  // namespace

Lines::Lines(const ResultRecord& record, Verification& result) : record_(record), result_(result) {
  for (const auto& entry : kNotRecomputed) explain(entry.name, entry.why);
}

void Lines::add(const std::string& pointer, double recomputed, double tolerance) {
  cover(pointer);
  const double recorded = record_.number(pointer).value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::isnan(recorded) && !std::isfinite(recomputed)) return;
  const double rounding =
      recomputed == std::floor(recomputed) ? 0 : kRelative * std::fabs(recorded);  // counts have none
  result_.lines.push_back({pointer, recorded, recomputed, std::max(tolerance, rounding)});
}

void Lines::add_sum(const std::string& pointer, double recomputed, double tolerance) {
  cover(pointer);
  result_.lines.push_back({pointer + ", sum", record_.sum(pointer), recomputed, tolerance});
}

void Lines::add_deviation(const std::string& name, double largest, double tolerance) {
  result_.lines.push_back({name, 0, largest, tolerance});
}

void Lines::add_text(const std::string& pointer, const std::string& elsewhere, const std::string& where) {
  cover(pointer);
  add_deviation(pointer + ", against " + where, record_.text(pointer) == elsewhere ? 0 : 1, 0);
}

bool Lines::is_covered(const std::string& name) const {
  const std::vector<std::string> places = places_on_the_way(name);
  return std::any_of(places.begin(), places.end(), [this](const std::string& p) { return covered_.count(p) > 0; });
}

std::string Lines::reason_of(const std::string& name) const {
  std::string why = "no other file has it, and nothing here computes it";
  for (const std::string& place : places_on_the_way(name)) {
    const auto found = reasons_.find(place);
    if (found != reasons_.end()) why = found->second;
  }
  return why;
}

void Lines::name_the_rest() {
  std::vector<std::string> all = record_.leaves();
  all.insert(all.end(), there_.begin(), there_.end());
  std::set<std::string> holds_covered;  // places that have something covered in them
  for (const std::string& name : all) {
    if (!is_covered(name)) continue;
    for (const std::string& place : places_on_the_way(name)) holds_covered.insert(place);
  }
  std::set<std::string> named;
  std::vector<std::pair<std::string, std::string>> by_reason;  // in order of the first name
  for (const std::string& name : all) {
    const std::vector<std::string> places = places_on_the_way(name);
    const auto whole =
        std::find_if(places.begin(), places.end(), [&](const std::string& p) { return holds_covered.count(p) == 0; });
    if (whole == places.end() || !named.insert(*whole).second) continue;
    const std::string why = reason_of(name);
    auto entry = std::find_if(by_reason.begin(), by_reason.end(), [&](const auto& e) { return e.first == why; });
    if (entry == by_reason.end()) entry = by_reason.insert(by_reason.end(), {why, ""});
    entry->second += (entry->second.empty() ? "" : ", ") + *whole;
  }
  for (const auto& [why, names] : by_reason) result_.not_recomputed.push_back(names + ": " + why);
}

}  // namespace espdiff
