// probed_causes.cpp: sentences, CSV rows and JSON of scans and of side chains in other places.
#include "report/sections/probed_causes.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/formatted.h"
#include "base/not_a_number.h"
#include "causes/causes.h"
#include "io/files/write_csv.h"
#include "report/sections/cause_numbers.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

constexpr std::size_t kMostNamed = 3;

/// "LYS 118 A, ARG 171 A and 31 others": the residues of the side chains, each once.
std::string side_chains_in_words(const Causes& causes, const PlacementInterval& interval) {
  std::vector<std::size_t> residues;
  for (const SideChainShift& shift : interval.side_chains) {
    if (std::count(residues.begin(), residues.end(), shift.change) == 0) residues.push_back(shift.change);
  }
  std::string text;
  for (std::size_t i = 0; i < residues.size() && i < kMostNamed; ++i)
    text += (i > 0 ? ", " : "") + causes.changes[residues[i]].name(causes.has_chains);
  return std::to_string(residues.size()) + (residues.size() == 1 ? " side chain" : " side chains") +
         " in other places (" + text + (residues.size() > kMostNamed ? ", ..." : "") + ")";
}

/// "ARG 171 -1.2, ASP 53 +0.9": the largest shifts of the source's reading.
std::string largest_shifts(const Causes& causes, const CausesOfReading& reading, double ScannedResidue::*shift,
                           const CauseNumbers& number) {
  std::vector<const ScannedResidue*> sorted;
  for (const ScannedResidue& scanned : reading.scan) {
    if (std::isfinite(scanned.*shift)) sorted.push_back(&scanned);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [&](const ScannedResidue* a, const ScannedResidue* b) {
    return std::fabs(a->*shift) > std::fabs(b->*shift);
  });
  std::string text;
  for (std::size_t i = 0; i < sorted.size() && i < kMostNamed; ++i)
    text += (i > 0 ? ", " : "") + causes.changes[sorted[i]->change].name(causes.has_chains) + " " +
            number(sorted[i]->*shift);
  return text.empty() ? "none" : text;
}

nlohmann::ordered_json named(const Causes& causes, std::size_t change) {
  const ResidueChange& of = causes.changes[change];
  return {{"residue", of.name(causes.has_chains)},
          {"chain", of.residue.chain},
          {"number", of.residue.number},
          {"name", of.residue.name}};
}

std::vector<std::string> name_cells(const std::string& reading, const ResidueChange& change) {
  return {reading, change.residue.chain, std::to_string(change.residue.number),
          change.residue.insertion_code == ' ' ? "" : std::string(1, change.residue.insertion_code),
          change.residue.name};
}

std::string cell(double value) { return std::isfinite(value) ? csv_number(value) : ""; }

}  // namespace

std::string placements_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit) {
  const PlacementInterval& interval = *reading.placements;
  if (interval.side_chains.empty())
    return "no side chain is poorly known or turned, at the surface and free to lie otherwise: there is no interval";
  const CauseNumbers number(causes, reading);
  return "with " + side_chains_in_words(causes, interval) + ": " + number(reading.difference()) + " (" +
         number(interval.low) + " to " + number(interval.high) + ") " + unit + ", 95 % of " +
         std::to_string(interval.n_draws) + " draws, mean " + number(interval.mean) +
         (interval.is_exact ? "; exact at these points of the surface"
                            : "; to first order: the shape of the solute is kept") +
         (interval.spans_zero() ? "; the interval spans zero: the structures do not tell the sign" : "");
}

std::string scan_in_words(const Causes& causes, const CausesOfReading& reading, const std::string& unit) {
  const CauseNumbers number(causes, reading);
  return "scan, " + unit + " in the source, shape and protonation kept: without its charges " +
         largest_shifts(causes, reading, &ScannedResidue::removed_source, number) +
         ", ...; with one charge more at their centre " +
         largest_shifts(causes, reading, &ScannedResidue::plus_source, number) + ", ... (one less: the opposite)";
}

nlohmann::ordered_json placements_json(const Causes& causes, const CausesOfReading& reading) {
  const PlacementInterval& interval = *reading.placements;
  nlohmann::ordered_json json{{"n_draws", interval.n_draws},
                              {"seed", interval.seed},
                              {"order", interval.is_exact ? "exact" : "first"},
                              {"low", json_number(interval.low)},
                              {"high", json_number(interval.high)},
                              {"mean", json_number(interval.mean)},
                              {"sd", json_number(interval.sd)},
                              {"spans_zero", interval.spans_zero()},
                              {"residues", nlohmann::ordered_json::array()}};
  for (const SideChainShift& shift : interval.side_chains) {
    nlohmann::ordered_json one = named(causes, shift.change);
    one["state"] = shift.of_target ? "target" : "source";
    one["n_placements"] = shift.shifts.size() - 1;
    one["n_clashing"] = shift.n_refused;
    one["least_shift"] = json_number(shift.least());
    one["most_shift"] = json_number(shift.most());
    json["residues"].push_back(std::move(one));
  }
  return json;
}

nlohmann::ordered_json scan_json(const Causes& causes, const CausesOfReading& reading) {
  constexpr std::size_t kMostResidues = 30;
  nlohmann::ordered_json json{{"kept", "shape and protonation"},
                              {"n_residues", reading.scan.size()},
                              {"largest", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < reading.scan.size() && i < kMostResidues; ++i) {
    const ScannedResidue& scanned = reading.scan[i];
    nlohmann::ordered_json one = named(causes, scanned.change);
    const auto both = [](double source, double target) {
      return nlohmann::ordered_json{{"source", json_number(source)}, {"target", json_number(target)}};
    };
    one["removed"] = both(scanned.removed_source, scanned.removed_target);
    one["plus_one"] = both(scanned.plus_source, scanned.plus_target);
    one["minus_one"] = both(-scanned.plus_source, -scanned.plus_target);
    one["distance_A"] = json_number(scanned.distance_A);
    json["largest"].push_back(std::move(one));
  }
  return json;
}

void write_scan(std::ostream& out, const Causes& causes, const std::string& unit) {
  const std::string in_unit = " [" + unit + "]";
  write_csv_row(out,
                {"reading", "chain", "residue_number", "insertion_code", "residue_name", "removed_source" + in_unit,
                 "removed_target" + in_unit, "plus_one_source" + in_unit, "plus_one_target" + in_unit,
                 "minus_one_source" + in_unit, "minus_one_target" + in_unit, "distance [A]"});
  for (const CausesOfReading& reading : causes.readings) {
    for (const ScannedResidue& scanned : reading.scan) {
      std::vector<std::string> cells = name_cells(reading.name, causes.changes[scanned.change]);
      for (const double value : {scanned.removed_source, scanned.removed_target, scanned.plus_source,
                                 scanned.plus_target, -scanned.plus_source, -scanned.plus_target, scanned.distance_A})
        cells.push_back(cell(value));
      write_csv_row(out, cells);
    }
  }
}

void write_side_chains(std::ostream& out, const Causes& causes, const std::string& unit) {
  write_csv_row(out, {"reading", "chain", "residue_number", "insertion_code", "residue_name", "state",
                      "angles [degrees]", "shift [" + unit + "]"});
  for (const CausesOfReading& reading : causes.readings) {
    if (!reading.placements) continue;
    for (const SideChainShift& shift : reading.placements->side_chains) {
      for (std::size_t p = 0; p < shift.shifts.size(); ++p) {
        std::vector<std::string> cells = name_cells(reading.name, causes.changes[shift.change]);
        std::string angles;
        for (const double angle : shift.angles[p]) angles += (angles.empty() ? "" : " ") + formatted("%.1f", angle);
        cells.insert(cells.end(), {shift.of_target ? "target" : "source", angles, csv_number(shift.shifts[p])});
        write_csv_row(out, cells);
      }
    }
  }
}

}  // namespace espdiff
