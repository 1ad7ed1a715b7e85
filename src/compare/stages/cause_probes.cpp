// cause_probes.cpp: builds the probes of a state, and sums what they add by residue and by draw.
#include "compare/stages/cause_probes.h"

#include <algorithm>
#include <cmath>

#include "align/residue_names.h"
#include "base/error.h"
#include "base/not_a_number.h"
#include "options/options.h"

namespace espdiff {
namespace {

bool is_backbone_atom(const std::string& name) {
  constexpr const char* kBackbone[] = {"N", "CA", "C", "O", "OXT", "H", "HN", "HA", "HA2", "HA3", "H1", "H2", "H3"};
  return std::any_of(std::begin(kBackbone), std::end(kBackbone), [&](const char* known) { return name == known; });
}

/// The centre of a residue's charges by their sizes: of its side chain, or of what it has.
Vec3d charge_centre(const Molecule& m, const std::vector<std::size_t>& atoms) {
  constexpr double kLeast = 0.05;
  std::vector<std::size_t> side;
  for (const std::size_t i : atoms) {
    const char letter = residue_letter(m.residues[static_cast<std::size_t>(m.atoms[i].residue)].name);
    if (letter == '?' || !is_backbone_atom(normalized_atom_name(m.atoms[i].name, letter))) side.push_back(i);
  }
  const std::vector<std::size_t>& of = side.empty() ? atoms : side;
  Vec3d by_charge{}, by_number{};
  double all = 0;
  for (const std::size_t i : of) {
    const double size = std::fabs(static_cast<double>(m.charges[i]));
    by_charge += size * m.positions[i];
    by_number += m.positions[i];
    all += size;
  }
  return all > kLeast ? (1 / all) * by_charge : (1 / static_cast<double>(of.size())) * by_number;
}

/// [side chain][placement] what it adds to the reading beyond the file's placement.
std::vector<std::vector<double>> shifts_of(const StateProbes& probes, const std::vector<double>& values) {
  std::vector<std::vector<double>> shifts;
  std::size_t next = probes.scanned.size();
  for (const SideChainPlacements& side_chain : probes.side_chains) {
    std::vector<double> sums;
    for (const std::vector<Vec3d>& places : side_chain.positions) {
      double sum = 0;
      for (std::size_t i = 0; i < places.size(); ++i) sum += values[next++];
      sums.push_back(sum);
    }
    const double of_file = sums.front();
    for (double& sum : sums) sum -= of_file;
    shifts.push_back(std::move(sums));
  }
  return shifts;
}

void add_side_chains(const StateProbes& probes, const std::vector<std::vector<double>>& shifts, bool of_target,
                     std::vector<SideChainShift>& all) {
  for (std::size_t s = 0; s < shifts.size(); ++s) {
    const SideChainPlacements& placed = probes.side_chains[s];
    all.push_back({placed.change, of_target, placed.angles, shifts[s], placed.n_refused});
  }
}

double sum_of_draw(const StateProbes& probes, const std::vector<std::vector<double>>& shifts, std::size_t draw) {
  double sum = 0;
  for (std::size_t s = 0; s < shifts.size(); ++s) sum += shifts[s][probes.drawn[draw][s]];
  return sum;
}

PlacementInterval interval_of(double difference, const StateProbes& source, const std::vector<double>& source_values,
                              const StateProbes& target, const std::vector<double>& target_values) {
  PlacementInterval interval;
  const auto of_source = shifts_of(source, source_values), of_target = shifts_of(target, target_values);
  add_side_chains(source, of_source, false, interval.side_chains);
  add_side_chains(target, of_target, true, interval.side_chains);
  std::stable_sort(
      interval.side_chains.begin(), interval.side_chains.end(),
      [](const SideChainShift& a, const SideChainShift& b) { return a.most() - a.least() > b.most() - b.least(); });
  const std::size_t n = source.drawn.size();
  for (std::size_t draw = 0; draw < n; ++draw)
    interval.draws.push_back(difference + sum_of_draw(target, of_target, draw) - sum_of_draw(source, of_source, draw));
  std::vector<double> sorted = interval.draws;
  std::sort(sorted.begin(), sorted.end());
  constexpr double kTail = 0.025;
  const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(n));
  interval.n_draws = n;
  interval.low = sorted[tail];
  interval.high = sorted[n - 1 - tail];
  for (const double d : sorted) interval.mean += d / static_cast<double>(n);
  double squares = 0;
  for (const double d : sorted) squares += (d - interval.mean) * (d - interval.mean);
  interval.sd = n > 1 ? std::sqrt(squares / static_cast<double>(n - 1)) : kNaN;
  return interval;
}

/// [change] what a unit charge at its charges' centre adds; NaN where the state lacks the residue.
std::vector<double> units_of(const StateProbes& probes, const std::vector<double>& values, std::size_t n_changes) {
  std::vector<double> units(n_changes, kNaN);
  for (std::size_t i = 0; i < probes.scanned.size(); ++i) units[probes.scanned[i]] = values[i];
  return units;
}

}  // namespace

StateProbes probes_of(const Molecule& molecule, const RigidTransform& to_common, const Causes& causes, bool of_target,
                      const std::vector<std::uint8_t>& may_move, const CompareOptions& options) {
  StateProbes probes;
  if (!options.scan && options.side_chains == 0) return probes;
  if (molecule.charges.size() != molecule.size())
    throw InputError((options.scan ? option("scan") : option("side-chains")) + ": the atoms of " + molecule.name +
                     " have no charges of their own; give structures with charges, such as PQR files");
  if (options.scan) {
    const std::vector<std::vector<std::size_t>> residues = atoms_of_residues(molecule);
    for (std::size_t c = 0; c < causes.changes.size(); ++c) {
      const std::int32_t r = of_target ? causes.changes[c].target : causes.changes[c].source;
      if (r < 0 || residues[static_cast<std::size_t>(r)].empty()) continue;
      probes.scanned.push_back(c);
      probes.charges.push_back({to_common.apply(charge_centre(molecule, residues[static_cast<std::size_t>(r)])), 0, 1});
    }
  }
  if (options.side_chains == 0) return probes;
  probes.side_chains = side_chain_placements(molecule, causes.changes, of_target, may_move, molecule.charges);
  for (const SideChainPlacements& side_chain : probes.side_chains) {
    for (const std::vector<Vec3d>& places : side_chain.positions) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t atom = side_chain.atoms[i];
        const float radius = molecule.radii.empty() ? 0.0F : molecule.radii[atom];
        probes.charges.push_back({to_common.apply(places[i]), radius, molecule.charges[atom]});
      }
    }
  }
  probes.drawn = draw_placements(molecule, probes.side_chains, static_cast<std::size_t>(options.side_chains),
                                 static_cast<std::uint64_t>(options.side_chain_seed), of_target);
  return probes;
}

void add_probed(Causes& causes, const StateProbes& source, const std::vector<double>& source_values,
                const StateProbes& target, const std::vector<double>& target_values, bool is_exact,
                const CompareOptions& options) {
  CausesOfReading& reading = causes.readings.back();
  if (options.scan) {
    const std::vector<double> in_source = units_of(source, source_values, causes.changes.size()),
                              in_target = units_of(target, target_values, causes.changes.size());
    for (const Contribution& c : reading.contributions) {
      const ResidueChange& change = causes.changes[c.change];
      if (change.source < 0 && change.target < 0) continue;
      reading.scan.push_back({c.change, c.distance_A, change.source < 0 ? kNaN : -c.source,
                              change.target < 0 ? kNaN : -c.target, in_source[c.change], in_target[c.change]});
    }
    std::stable_sort(reading.scan.begin(), reading.scan.end(),
                     [](const ScannedResidue& a, const ScannedResidue& b) { return a.largest() > b.largest(); });
  }
  if (options.side_chains == 0 || reading.name == "whole") return;  // a mean of sizes is not linear
  reading.placements = interval_of(reading.difference(), source, source_values, target, target_values);
  reading.placements->is_exact = is_exact;
  reading.placements->seed = static_cast<std::uint64_t>(options.side_chain_seed);
}

}  // namespace espdiff
