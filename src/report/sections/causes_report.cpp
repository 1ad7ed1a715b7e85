// causes_report.cpp: sentences, CSV rows and JSON of causes.
#include "report/sections/causes_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/formatted.h"
#include "causes/causes.h"
#include "io/files/write_csv.h"
#include "report/sections/cause_numbers.h"
#include "report/sections/json_number.h"
#include "report/sections/probed_causes.h"

namespace espdiff {
namespace {

/// "2 residues that are substituted"
std::string kind_in_words(const KindSum& sum) {
  const bool one = sum.contributions.size() == 1;
  const auto counted = [&](const char* singular, const char* plural) {
    return std::to_string(sum.contributions.size()) + " " + (one ? singular : plural);
  };
  switch (sum.kind) {
    case CauseKind::kSubstituted: return counted("substituted residue", "substituted residues");
    case CauseKind::kLigand: return counted("ligand, cofactor or ion", "ligands, cofactors and ions");
    case CauseKind::kUnpaired: return counted("residue without a partner", "residues without a partner");
    case CauseKind::kProtonation: return counted("residue protonated otherwise", "residues protonated otherwise");
    case CauseKind::kTerminus: return counted("end of a chain", "ends of chains");
    case CauseKind::kCharges: return counted("residue charged otherwise", "residues charged otherwise");
    case CauseKind::kRebuilt:
      return counted("residue whose missing atoms were placed", "residues whose missing atoms were placed");
    case CauseKind::kBackbone: return counted("residue whose backbone moved", "residues whose backbone moved");
    case CauseKind::kSideChain: return counted("side chain that turned", "side chains that turned");
    case CauseKind::kMoved: return counted("residue that moved otherwise", "residues that moved otherwise");
    case CauseKind::kSurroundings: break;
  }
  return counted("residue in its place, seen through other surroundings",
                 "residues in their places, seen through other surroundings");
}

/// " (LYS 118 -0.36, LYS 56 -0.12, ...)": the largest, at least a tenth of the sum of all.
std::string examples(const Causes& causes, const KindSum& sum, const CauseNumbers& number) {
  constexpr std::size_t kMost = 3;
  constexpr double kLeast = 0.2;
  std::string text;
  std::size_t n = 0;
  const double largest = sum.contributions.empty() ? 0 : std::fabs(sum.contributions.front()->difference());
  for (const Contribution* c : sum.contributions) {
    if (n == kMost || std::fabs(c->difference()) < kLeast * largest || number.is_zero(c->difference())) break;
    const ResidueChange& change = causes.changes[c->change];
    const bool is_named = change.kind == CauseKind::kSubstituted || change.kind == CauseKind::kProtonation ||
                          change.kind == CauseKind::kSideChain;
    text += (n++ > 0 ? ", " : "") + change.name(causes.has_chains) +
            (is_named && !change.detail.empty() ? ", " + change.detail + ", " : " ") + number(c->difference());
  }
  if (n == 0) return {};
  return " (" + text + (sum.contributions.size() > n ? ", ...)" : ")");
}

nlohmann::ordered_json knowledge_json(const PlaceKnowledge& known, bool is_there) {
  if (!is_there) return nullptr;
  return {{"relative_b", json_number(known.relative_b)},
          {"occupancy", json_number(known.occupancy)},
          {"has_alternates", known.has_alternates},
          {"is_rebuilt", known.is_rebuilt}};
}

nlohmann::ordered_json contribution_json(const Causes& causes, const Contribution& c) {
  const ResidueChange& change = causes.changes[c.change];
  const Residue& residue = change.residue;
  return {{"residue", change.name(causes.has_chains)},
          {"chain", residue.chain},
          {"number", residue.number},
          {"insertion_code", residue.insertion_code == ' ' ? "" : std::string(1, residue.insertion_code)},
          {"name", residue.name},
          {"kind", to_string(change.kind)},
          {"detail", change.detail},
          {"source", json_number(c.source)},
          {"target", json_number(c.target)},
          {"difference", json_number(c.difference())},
          {"distance_A", json_number(c.distance_A)},
          {"moved_A", json_number(change.moved_A)},
          {"poorly_known", change.is_poorly_known()},
          {"place",
           {{"source", knowledge_json(change.in_source, change.source >= 0)},
            {"target", knowledge_json(change.in_target, change.target >= 0)}}}};
}

}  // namespace

std::string causes_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit) {
  const CauseNumbers number(causes, reading);
  constexpr std::size_t kMostKinds = 5;
  std::string text = "the difference is " + number(reading.difference()) + " " + unit;
  double rest = 0;
  std::size_t n = 0, n_rest = 0;
  for (const KindSum& sum : sums_by_kind(causes, reading)) {
    // What the substitutions make is what a reader asks for, also where it is nothing.
    const bool is_said = sum.kind == CauseKind::kSubstituted || (n < kMostKinds && !number.is_zero(sum.difference));
    if (!is_said) {
      rest += sum.difference;
      n_rest += sum.contributions.size();
      continue;
    }
    text += (n++ == 0 ? ": " : "; ") + number(sum.difference) + " from " + kind_in_words(sum) +
            examples(causes, sum, number);
  }
  if (n_rest > 0)
    text += std::string(n == 0 ? ": " : "; ") + number(rest) + " from the other " + std::to_string(n_rest) +
            (n_rest == 1 ? " residue" : " residues");
  return text;
}

std::string certainty_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit) {
  if (!causes.knows_places)
    return "no file says how well places are known (B factors), so neither does this; compare the deposited structures";
  const CauseNumbers number(causes, reading);
  const KindSum poor = poorly_known(causes, reading);
  if (poor.contributions.empty()) return "no residue's place is poorly known";
  std::string text = "of it, " + number(poor.difference) + " " + unit + " comes from " +
                     std::to_string(poor.contributions.size()) +
                     " residues whose place is poorly known (B factor above " + formatted("%g", kPoorRelativeB) +
                     " times the median, part occupancy, other places, or rebuilt)";
  constexpr std::size_t kMost = 3;
  for (std::size_t i = 0; i < poor.contributions.size() && i < kMost; ++i) {
    const Contribution& c = *poor.contributions[i];
    if (number.is_zero(c.difference())) break;
    const ResidueChange& change = causes.changes[c.change];
    const double b = std::fmax(change.in_source.relative_b, change.in_target.relative_b);
    text += (i == 0 ? ": " : ", ") + change.name(causes.has_chains) + " " + number(c.difference()) +
            (std::isfinite(b) ? " (B " + formatted("%.1f", b) + " times the median)" : "");
  }
  return text;
}

nlohmann::ordered_json causes_json(const Causes& causes, const std::string& unit) {
  constexpr std::size_t kMostResidues = 30;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const CausesOfReading& reading : causes.readings) {
    nlohmann::ordered_json json{
        {"reading", reading.name},
        {"source", json_number(reading.source)},
        {"target", json_number(reading.target)},
        {"difference", json_number(reading.difference())},
        {"sum_of_contributions",
         {{"source", json_number(reading.sum_of_source)}, {"target", json_number(reading.sum_of_target)}}},
        {"unit", unit},
        {"in_words", causes_in_words(causes, reading, unit)},
        {"certainty", certainty_in_words(causes, reading, unit)}};
    json["by_kind"] = nlohmann::ordered_json::array();
    for (const KindSum& sum : sums_by_kind(causes, reading))
      json["by_kind"].push_back({{"kind", to_string(sum.kind)},
                                 {"difference", json_number(sum.difference)},
                                 {"n_residues", sum.contributions.size()}});
    json["poorly_known"] =
        causes.knows_places ? json_number(poorly_known(causes, reading).difference) : nlohmann::ordered_json(nullptr);
    json["n_residues"] = reading.contributions.size();
    json["largest"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < reading.contributions.size() && i < kMostResidues; ++i)
      json["largest"].push_back(contribution_json(causes, reading.contributions[i]));
    if (reading.placements) {
      json["side_chains"] = placements_json(causes, reading);
      json["side_chains"]["in_words"] = placements_in_words(causes, reading, unit);
    }
    if (!reading.scan.empty()) {
      json["scan"] = scan_json(causes, reading);
      json["scan"]["in_words"] = scan_in_words(causes, reading, unit);
    }
    all.push_back(std::move(json));
  }
  return all;
}

void write_causes(std::ostream& out, const Causes& causes, const std::string& unit) {
  const std::string in_unit = " [" + unit + "]";
  write_csv_row(out, {"reading", "chain", "residue_number", "insertion_code", "residue_name", "kind", "detail",
                      "source" + in_unit, "target" + in_unit, "difference" + in_unit, "distance [A]", "moved [A]",
                      "relative_b_source", "relative_b_target", "occupancy_source", "occupancy_target",
                      "has_alternates", "is_rebuilt", "poorly_known"});
  for (const CausesOfReading& reading : causes.readings) {
    for (const Contribution& c : reading.contributions) {
      const ResidueChange& change = causes.changes[c.change];
      const bool is_compared = change.source >= 0 || change.target >= 0;
      const PlaceKnowledge &a = change.in_source, &b = change.in_target;
      const auto known = [](std::int32_t residue, double value) { return residue < 0 ? "" : csv_number(value); };
      const auto flag = [](bool value) { return value ? "1" : "0"; };
      write_csv_row(out, {reading.name, change.residue.chain, is_compared ? std::to_string(change.residue.number) : "",
                          change.residue.insertion_code == ' ' ? "" : std::string(1, change.residue.insertion_code),
                          change.residue.name, to_string(change.kind), change.detail, csv_number(c.source),
                          csv_number(c.target), csv_number(c.difference()), csv_number(c.distance_A),
                          csv_number(change.moved_A), known(change.source, a.relative_b),
                          known(change.target, b.relative_b), known(change.source, a.occupancy),
                          known(change.target, b.occupancy), flag(a.has_alternates || b.has_alternates),
                          flag(a.is_rebuilt || b.is_rebuilt), flag(change.is_poorly_known())});
    }
  }
}

}  // namespace espdiff
