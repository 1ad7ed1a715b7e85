// input_warnings.cpp: checks of each molecule, of the paired residues, and of the superposition.
#include "input_checks/input_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "align/geometry/chain_motions.h"
#include "align/geometry/superpose.h"
#include "align/pair_residues.h"
#include "base/error.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "input_checks/broken_chains.h"
#include "input_checks/charge_warnings.h"
#include "input_checks/exchanged_side_chains.h"
#include "input_checks/geometry_warnings.h"
#include "input_checks/register_warning.h"
#include "input_checks/surroundings.h"

namespace espdiff {
namespace {

/// Twice the volume of the tetrahedron at C-alpha is 2.5 A^3 in size; half of it tells the hand.
constexpr double kLeastVolume_A3 = 1.2;
constexpr double kMostInverted = 0.05;
/// Unrelated shapes of one size superpose with an RMSD of about 0.6 of this root.
constexpr double kMostRelativeRmsd = 0.45;
constexpr std::size_t kLeastChain = 20;
/// A chain that fits by itself and lies farther than these from its place is noted, and is arranged differently.
constexpr double kNotedChainShift_A = 2, kLeastChainShift_A = 6, kMostChainFit_A = 4, kShiftToFit = 3;
constexpr std::size_t kLeastLigandAtoms = 5;
/// A ligand is noted whose atoms lie farther than this from where its surroundings put them.
constexpr double kNotedLigand_A = 2;
constexpr double kManyHydrogens = 0.3, kFewHydrogens = 0.05;
constexpr double kNotedRadii_A = 0.05, kMostRadii_A = 0.15;

using AtomPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The atom of this name; -1 if the residue has none.
std::ptrdiff_t find_atom(const ResidueView& view, std::size_t residue, std::string_view name) {
  for (const std::size_t i : view.atoms[residue]) {
    if (view.molecule->atoms[i].name == name) return static_cast<std::ptrdiff_t>(i);
  }
  return -1;
}

/// Signed volume at the centre of a residue; 0 if an atom is missing.
double hand(const ResidueView& view, std::size_t residue) {
  static constexpr std::array<std::string_view, 4> kAminoAcid = {"CA", "N", "C", "CB"},
                                                   kNucleotide = {"C4'", "C5'", "C3'", "O4'"};
  std::array<Vec3d, 4> p;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& names = view.kinds[residue] == ResidueKind::kAminoAcid ? kAminoAcid : kNucleotide;
    const std::ptrdiff_t atom = find_atom(view, residue, names[k]);
    if (atom < 0) return 0;
    p[k] = view.molecule->positions[static_cast<std::size_t>(atom)];
  }
  return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
}

void check_chirality(const PairedMolecules& pair, std::vector<Warning>& warnings) {
  const ResidueView &source = pair.source, &target = pair.target;
  const std::vector<std::int32_t>& partner = pair.target_of;
  std::size_t n = 0, n_inverted = 0;
  std::string examples;
  for (std::size_t r = 0; r < partner.size(); ++r) {
    if (partner[r] < 0 || !is_polymer(source.kinds[r])) continue;
    const auto t = static_cast<std::size_t>(partner[r]);
    if (!is_polymer(target.kinds[t])) continue;
    const double a = hand(source, r), b = hand(target, t);
    if (std::fabs(a) < kLeastVolume_A3 || std::fabs(b) < kLeastVolume_A3) continue;
    ++n;
    if (a * b > 0) continue;
    if (++n_inverted <= 3) examples += (examples.empty() ? "" : ", ") + residue_label(source.molecule->residues[r]);
  }
  if (n_inverted == 0) return;
  const bool mirrored = static_cast<double>(n_inverted) > kMostInverted * static_cast<double>(n);
  warnings.push_back(
      {std::to_string(n_inverted) + " of " + std::to_string(n) + " paired residues have the opposite chirality (" +
           examples + (n_inverted > 3 ? ", ..." : "") + ")" +
           (mirrored ? ": one molecule is a mirror image, whole or in part, or its atoms are in another order than "
                       "their names (read a trajectory with the topology that it was written with)"
                     : ""),
       mirrored});
}

/// Mean squared distance from the centroid.
double square_radius(const std::vector<Vec3d>& positions, const std::vector<std::size_t>& atoms) {
  Vec3d centre{};
  for (const std::size_t i : atoms) centre += positions[i];
  centre = (1 / static_cast<double>(atoms.size())) * centre;
  double sum = 0;
  for (const std::size_t i : atoms) sum += dot(positions[i] - centre, positions[i] - centre);
  return sum / static_cast<double>(atoms.size());
}

void check_rmsd(const Molecule& source, const Molecule& target, const Alignment& alignment,
                std::vector<Warning>& warnings) {
  if (alignment.pairing.pairs.empty() || !std::isfinite(alignment.rmsd_A)) return;
  double rmsd_A = alignment.rmsd_A, n_in_domains = 0, squares = 0;
  for (const RigidDomain& domain : alignment.domains) {
    n_in_domains += static_cast<double>(domain.n_atoms);
    squares += static_cast<double>(domain.n_atoms) * domain.rmsd_A * domain.rmsd_A;
  }
  if (n_in_domains > 0) rmsd_A = std::sqrt(squares / n_in_domains);
  std::vector<std::size_t> of_source, of_target;
  for (const auto& [s, t] : alignment.pairing.pairs) {
    of_source.push_back(s);
    of_target.push_back(t);
  }
  const double size =
      std::sqrt(square_radius(source.positions, of_source) + square_radius(target.positions, of_target));
  if (!(rmsd_A > kMostRelativeRmsd * size)) return;
  warnings.push_back({"an RMSD of " + short_number(rmsd_A) + " A is that of unrelated shapes of this size (" +
                          short_number(size / std::sqrt(2.0)) +
                          " A radius of gyration): the superposition means nothing; if parts moved as rigid bodies, "
                          "give " +
                          option("domains", "auto"),
                      true});
}

/// The chain that turned or shifted most against those that keep their arrangement.
void note_chain_motion(const Alignment& alignment, std::vector<Warning>& warnings) {
  const ChainMotion* farthest = nullptr;
  for (const ChainMotion& motion : alignment.chain_motions) {
    if (motion.own_rmsd_A > kMostChainFit_A || motion.rmsd_A < kShiftToFit * motion.own_rmsd_A) continue;
    if (motion.rmsd_A < kNotedChainShift_A) continue;
    if (farthest == nullptr || motion.rmsd_A > farthest->rmsd_A) farthest = &motion;
  }
  if (farthest == nullptr) return;
  warnings.push_back({"a chain turned and shifted against the others: " + in_words({*farthest}) +
                          "; what differs at its border is that motion, too",
                      false});
}

/// Chains that fit by themselves, but not where the others put them.
void check_arrangement(const Molecule& source, const Molecule& target, const Alignment& alignment,
                       std::vector<Warning>& warnings) {
  std::map<std::string, std::pair<AtomPairs, std::set<std::int32_t>>> chains;
  for (const auto& pair : alignment.pairing.pairs) {
    const std::int32_t residue = source.atoms[pair.first].residue;
    auto& [pairs, residues] = chains[source.residues[static_cast<std::size_t>(residue)].chain];
    pairs.push_back(pair);
    residues.insert(residue);
  }
  for (auto entry = chains.begin(); entry != chains.end();) {
    entry = entry->second.second.size() < kLeastChain ? chains.erase(entry) : std::next(entry);
  }
  if (chains.size() < 2) return;
  std::tuple<double, std::string, double> worst{0, "", 0};
  for (const auto& [name, chain] : chains) {
    AtomPairs others;
    for (const auto& [other, of_other] : chains) {
      if (other != name) others.insert(others.end(), of_other.first.begin(), of_other.first.end());
    }
    try {
      const RigidTransform motion = superpose(source.positions, target.positions, others).transform;
      const Superposition own = superpose(source.positions, target.positions, chain.first);
      double squares = 0;
      for (const auto& [s, t] : chain.first) {
        const Vec3d d = motion.apply(source.positions[s]) - target.positions[t];
        squares += dot(d, d);
      }
      const double shift = std::sqrt(squares / static_cast<double>(chain.first.size()));
      if (own.rmsd_A > kMostChainFit_A || shift < kLeastChainShift_A || shift < kShiftToFit * own.rmsd_A) continue;
      worst = std::max(worst, {shift, name, own.rmsd_A});
    } catch (const GeometryError&) {
      continue;
    }
  }
  const auto& [shift, name, own] = worst;
  if (shift == 0) {
    note_chain_motion(alignment, warnings);
    return;
  }
  const bool has_domains = !alignment.domains.empty();
  warnings.push_back({"the chains are arranged differently: chain " + name + " fits by " + short_number(own) +
                          " A alone, and lies " + short_number(shift) + " A from where the others put it (" +
                          in_words(alignment.chain_motions) + ")" +
                          (has_domains ? Message("; surfaces between chains have no counterpart")
                                       : "; give " + option("domains", "chains") + ", or compare one chain"),
                      !has_domains});
}

/// Additives of crystals and buffers: where they lie says nothing about the molecule.
bool is_additive(const std::string& name) {
  static const std::set<std::string> names{"SO4", "PO4", "GOL", "EDO", "PEG", "PGE", "PG4", "1PE", "ACT", "ACY", "MPD",
                                           "DMS", "FMT", "IPA", "EOH", "MES", "TRS", "EPE", "BME", "CIT", "NO3", "NH4",
                                           "IMD", "MRD", "P6G", "TLA", "HED", "BCT", "CO3", "NAG", "AZI", "SCN"};
  return names.count(name) != 0;
}

/// Paired ligands that lie otherwise in their sites.
void check_poses(const PairedMolecules& pair, const AtomPairing& pairing, std::vector<Warning>& warnings) {
  const Molecule &source = *pair.source.molecule, &target = *pair.target.molecule;
  std::map<std::int32_t, AtomPairs> ligands;
  for (const auto& [s, t] : pairing.pairs) {
    const std::int32_t residue = source.atoms[s].residue;
    if (pair.source.kinds[static_cast<std::size_t>(residue)] == ResidueKind::kOther && source.atoms[s].element != "H")
      ligands[residue].emplace_back(s, t);
  }
  for (const auto& [residue, atoms] : ligands) {
    const Residue& ligand = source.residues[static_cast<std::size_t>(residue)];
    if (atoms.size() < kLeastLigandAtoms || is_additive(ligand.name)) continue;
    Vec3d centre{}, shift{};
    for (const auto& [s, t] : atoms) centre += source.positions[s];
    const double n = static_cast<double>(atoms.size());
    const auto motion = pair.surroundings.motion_around((1 / n) * centre);
    if (!motion) continue;
    double squares = 0;
    for (const auto& [s, t] : atoms) {
      const Vec3d off = target.positions[t] - motion->apply(source.positions[s]);
      shift += off;
      squares += dot(off, off);
    }
    const double rmsd_A = std::sqrt(squares / n);
    if (rmsd_A > kNotedLigand_A)
      warnings.push_back({"the ligand " + residue_label(ligand) + " lies otherwise in its site: its atoms by " +
                              short_number(rmsd_A) + " A, its centre by " + short_number(norm((1 / n) * shift)) +
                              " A from where the residues around it went",
                          false});
  }
}

void check_ligands(const ResidueView& source, const Alignment& alignment, std::vector<Warning>& warnings) {
  std::size_t n_small = 0;
  double farthest = 0;
  for (const MovedResidue& moved : alignment.pairing.moved) {
    const Residue& residue = source.molecule->residues[moved.source];
    if (source.atoms[moved.source].size() < kLeastLigandAtoms || is_additive(residue.name)) {
      ++n_small;
      farthest = std::max(farthest, moved.distance_A);
      continue;
    }
    warnings.push_back({"the ligand " + residue_label(residue) + " moved: it lies " + short_number(moved.distance_A) +
                            " A from where the residues around it went, and its surface was not compared",
                        true});
  }
  if (n_small > 0)
    warnings.push_back({std::to_string(n_small) + (n_small == 1 ? " ion or additive" : " ions or additives") +
                            " moved by more than 4 A (up to " + short_number(farthest) +
                            " A) and did not pair: the surface there was not compared",
                        false});
  std::string exchanged;
  for (const auto& [a, b] : alignment.pairing.exchanged_chains)
    exchanged += (exchanged.empty() ? "" : ", ") + a + " with " + b;
  if (!exchanged.empty())
    warnings.push_back({"equal chains pair by their arrangement, not by their names: " + exchanged, false});
}

double hydrogen_share(const Molecule& molecule) {
  const auto n = std::count_if(molecule.atoms.begin(), molecule.atoms.end(),
                               [](const Atom& atom) { return atom.element == "H" || atom.element == "D"; });
  return static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(1, molecule.atoms.size()));
}

void check_radii(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                 std::vector<Warning>& warnings) {
  const double a = hydrogen_share(source), b = hydrogen_share(target);
  if (std::max(a, b) > kManyHydrogens && std::min(a, b) < kFewHydrogens) {
    warnings.push_back({std::string("only the ") + (a > b ? "source" : "target") +
                            " has hydrogens: the surfaces differ by their radii as well; prepare both molecules alike",
                        true});
    return;
  }
  double sum = 0, n = 0;
  for (const auto& [s, t] : pairing.pairs) {
    if (!(source.radii[s] > 0) || !(target.radii[t] > 0)) continue;
    sum += std::fabs(static_cast<double>(source.radii[s]) - static_cast<double>(target.radii[t]));
    ++n;
  }
  if (n == 0 || sum / n <= kNotedRadii_A) return;
  warnings.push_back({"the radii of paired atoms differ by " + short_number(sum / n) +
                          " A on average, so the surfaces differ without a change of the molecule; take the radii of "
                          "one origin",
                      sum / n > kMostRadii_A});
}

/// Runs checks beside each other. @returns [check] its warnings
/// @throws what the first of those that fail throws
std::vector<std::vector<Warning>> by_all(const std::vector<std::function<void(std::vector<Warning>&)>>& checks) {
  std::vector<std::vector<Warning>> warnings(checks.size());
  std::vector<std::exception_ptr> errors(checks.size());
  const auto n = static_cast<std::ptrdiff_t>(checks.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const auto check = static_cast<std::size_t>(k);
    try {
      checks[check](warnings[check]);
    } catch (...) {
      errors[check] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error != nullptr) std::rethrow_exception(error);
  }
  return warnings;
}

}  // namespace

std::vector<Warning> input_warnings(const Molecule& source, const Molecule& target, const Alignment& alignment) {
  const PairedMolecules pair(source, target, alignment.pairing);
  bool source_is_known = false, target_is_known = false;
  using Warnings = std::vector<Warning>;
  constexpr std::size_t kPairedCharges = 5;  // counts where both molecules' charges can be told
  const auto warnings = by_all({
      [&](Warnings& w) { check_chains(pair, w); },
      [&](Warnings& w) { check_geometry("source", pair.source, w); },
      [&](Warnings& w) { check_geometry("target", pair.target, w); },
      [&](Warnings& w) { source_is_known = check_charges("source", pair.source, w); },
      [&](Warnings& w) { target_is_known = check_charges("target", pair.target, w); },
      [&](Warnings& w) { check_paired_charges(pair.source, pair.target, alignment.pairing, w); },
      [&](Warnings& w) { check_chirality(pair, w); },
      [&](Warnings& w) { check_register(pair, alignment, w); },
      [&](Warnings& w) { check_side_chains(pair, w); },
      [&](Warnings& w) { check_rmsd(source, target, alignment, w); },
      [&](Warnings& w) { check_arrangement(source, target, alignment, w); },
      [&](Warnings& w) { check_ligands(pair.source, alignment, w); },
      [&](Warnings& w) { check_poses(pair, alignment.pairing, w); },
      [&](Warnings& w) { check_radii(source, target, alignment.pairing, w); },
  });
  Warnings all;
  for (std::size_t k = 0; k < warnings.size(); ++k) {
    if (k == kPairedCharges && !(source_is_known && target_is_known)) continue;
    all.insert(all.end(), warnings[k].begin(), warnings[k].end());
  }
  return all;
}

}  // namespace espdiff
