// causes.cpp: sums the contributions of charges by residue, and those of residues by what changed about them.
#include "causes/causes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "align/residue_names.h"
#include "base/not_a_number.h"

namespace espdiff {
namespace {

using Key = std::tuple<std::string, std::int32_t, char, std::string>;
Key key_of(const Residue& r) { return {r.chain, r.number, r.insertion_code, r.name}; }

/// [residue] the distance of its nearest atom from the nearest of the points; NaN without points.
std::vector<double> distances(const Molecule& molecule, const std::vector<Vec3d>& points) {
  // A thinner set of points is near enough: the distance is for a reader.
  constexpr std::size_t kMostPoints = 2000;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMostPoints);
  std::vector<double> squares(molecule.residues.size(), kNaN);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    double& nearest = squares[static_cast<std::size_t>(molecule.atoms[i].residue)];
    for (std::size_t p = 0; p < points.size(); p += step) {
      const Vec3d d = molecule.positions[i] - points[p];
      nearest = std::fmin(nearest, dot(d, d));
    }
  }
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

/// The index of the row of residues that are not compared, which is made where there is none.
std::size_t change_of_others(Causes& causes, const std::string& name, std::size_t n) {
  for (std::size_t i = causes.changes.size(); i-- > 0;) {
    ResidueChange& change = causes.changes[i];
    if (change.source >= 0 || change.target >= 0) break;
    if (change.residue.name != name) continue;
    change.n_residues = std::max(change.n_residues, n);
    return i;
  }
  ResidueChange change;
  change.residue.name = name;
  change.n_residues = n;
  change.kind = CauseKind::kLigand;
  change.detail = "not compared";
  change.moved_A = change.in_source.relative_b = change.in_target.relative_b = kNaN;
  causes.changes.push_back(change);
  return causes.changes.size() - 1;
}

}  // namespace

const char* to_string(CauseKind kind) {
  switch (kind) {
    case CauseKind::kSubstituted: return "substituted";
    case CauseKind::kLigand: return "ligand";
    case CauseKind::kUnpaired: return "unpaired";
    case CauseKind::kProtonation: return "protonation";
    case CauseKind::kTerminus: return "terminus";
    case CauseKind::kCharges: return "charges";
    case CauseKind::kRebuilt: return "rebuilt";
    case CauseKind::kBackbone: return "backbone_moved";
    case CauseKind::kSideChain: return "side_chain_turned";
    case CauseKind::kMoved: return "moved";
    case CauseKind::kSurroundings: break;
  }
  return "surroundings";
}

std::string ResidueChange::name(bool with_chain) const {
  if (source < 0 && target < 0) return residue.name;
  std::string text = residue.name + " " + std::to_string(residue.number);
  if (residue.insertion_code != ' ') text += residue.insertion_code;
  return with_chain && !residue.chain.empty() ? text + " " + residue.chain : text;
}

double SideChainShift::least() const { return *std::min_element(shifts.begin(), shifts.end()); }
double SideChainShift::most() const { return *std::max_element(shifts.begin(), shifts.end()); }

double ScannedResidue::largest() const {
  double size = 0;
  for (const double shift : {removed_source, removed_target, plus_source, plus_target})
    size = std::fmax(size, std::fabs(shift));
  return size;
}

ResidueSums sum_by_residue(const Molecule& molecule, const Molecule& charges,
                           const std::vector<double>& contributions) {
  ResidueSums sums;
  sums.of_residue.assign(molecule.residues.size(), 0.0);
  std::map<Key, std::size_t> index;
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) index.emplace(key_of(molecule.residues[r]), r);
  std::vector<std::ptrdiff_t> compared;  // [residue of the charges]
  for (const Residue& residue : charges.residues) {
    const auto found = index.find(key_of(residue));
    compared.push_back(found == index.end() ? -1 : static_cast<std::ptrdiff_t>(found->second));
    if (found == index.end()) ++sums.of_others[residue.name].second;
  }
  // Charges alone, without names, are the molecule's own, or of nobody.
  const bool same_atoms = charges.atoms.empty() && charges.size() == molecule.size();
  for (std::size_t i = 0; i < contributions.size(); ++i) {
    const double c = contributions[i];
    sums.all += c;
    const Molecule& named = same_atoms ? molecule : charges;
    if (named.atoms.empty()) {
      sums.of_others["charges"].first += c;
      continue;
    }
    const auto residue = static_cast<std::size_t>(named.atoms[i].residue);
    const std::ptrdiff_t r = same_atoms ? static_cast<std::ptrdiff_t>(residue) : compared[residue];
    if (r >= 0) {
      sums.of_residue[static_cast<std::size_t>(r)] += c;
    } else {
      sums.of_others[named.residues[residue].name].first += c;
    }
  }
  return sums;
}

void add_reading(Causes& causes, const std::string& name, const StateReading& source, const StateReading& target) {
  CausesOfReading reading;
  reading.name = name;
  reading.source = source.reading;
  reading.target = target.reading;
  const ResidueSums a = sum_by_residue(source.molecule, source.charges, source.contributions),
                    b = sum_by_residue(target.molecule, target.charges, target.contributions);
  reading.sum_of_source = a.all;
  reading.sum_of_target = b.all;
  const std::vector<double> source_distances = distances(source.molecule, source.surface),
                            target_distances = distances(target.molecule, target.surface);
  for (std::size_t i = 0; i < causes.changes.size(); ++i) {
    const ResidueChange& change = causes.changes[i];
    Contribution c;
    c.change = i;
    c.distance_A = kNaN;
    if (change.source >= 0) {
      c.source = a.of_residue[static_cast<std::size_t>(change.source)];
      c.distance_A = source_distances[static_cast<std::size_t>(change.source)];
    }
    if (change.target >= 0) {
      c.target = b.of_residue[static_cast<std::size_t>(change.target)];
      c.distance_A = std::fmin(c.distance_A, target_distances[static_cast<std::size_t>(change.target)]);
    }
    if (change.source >= 0 || change.target >= 0) reading.contributions.push_back(c);
  }
  std::map<std::string, Contribution> of_others;
  for (const auto& [residue, sum] : a.of_others) {
    of_others[residue].change = change_of_others(causes, residue, sum.second);
    of_others[residue].source = sum.first;
  }
  for (const auto& [residue, sum] : b.of_others) {
    of_others[residue].change = change_of_others(causes, residue, sum.second);
    of_others[residue].target = sum.first;
  }
  for (auto& [residue, c] : of_others) {
    c.distance_A = kNaN;
    reading.contributions.push_back(c);
  }
  std::stable_sort(reading.contributions.begin(), reading.contributions.end(),
                   [](const Contribution& x, const Contribution& y) {
                     return std::fabs(x.difference()) > std::fabs(y.difference());
                   });
  causes.readings.push_back(std::move(reading));
}

std::vector<KindSum> sums_by_kind(const Causes& causes, const CausesOfReading& reading) {
  std::vector<KindSum> sums;
  for (const CauseKind kind : kCauseKinds) {
    KindSum sum;
    sum.kind = kind;
    for (const Contribution& c : reading.contributions) {
      if (causes.changes[c.change].kind != kind) continue;
      sum.difference += c.difference();
      sum.contributions.push_back(&c);
    }
    if (!sum.contributions.empty()) sums.push_back(std::move(sum));
  }
  std::stable_sort(sums.begin(), sums.end(), [](const KindSum& x, const KindSum& y) {
    return std::fabs(x.difference) > std::fabs(y.difference);
  });
  return sums;
}

KindSum poorly_known(const Causes& causes, const CausesOfReading& reading) {
  KindSum sum;
  for (const Contribution& c : reading.contributions) {
    if (!causes.changes[c.change].is_poorly_known()) continue;
    sum.difference += c.difference();
    sum.contributions.push_back(&c);
  }
  return sum;
}

}  // namespace espdiff
