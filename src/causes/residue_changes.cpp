// residue_changes.cpp: finds what changed about each residue, and how well its place is known.
#include "causes/residue_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "align/residue_names.h"
#include "base/formatted.h"
#include "base/not_a_number.h"
#include "causes/causes.h"
#include "causes/chi_angles.h"

namespace espdiff {
namespace {

using ResidueAtoms = std::vector<std::vector<std::size_t>>;

bool is_hydrogen(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

bool is_backbone(const std::string& name) { return name == "N" || name == "CA" || name == "C" || name == "O"; }

/// The median B factor of the heavy atoms; NaN where the file does not know them.
double median_b(const Molecule& molecule) {
  std::vector<float> all;
  for (const Atom& atom : molecule.atoms) {
    if (std::isfinite(atom.b_factor) && !is_hydrogen(atom)) all.push_back(atom.b_factor);
  }
  if (all.empty() || *std::max_element(all.begin(), all.end()) <= *std::min_element(all.begin(), all.end()))
    return kNaN;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return static_cast<double>(all[all.size() / 2]);
}

/// @param median from median_b()
PlaceKnowledge knowledge_of(const Molecule& molecule, const std::vector<std::size_t>& atoms, double median) {
  PlaceKnowledge known;
  known.relative_b = kNaN;
  if (!std::isfinite(median)) return known;
  double largest = kNaN, of_any = kNaN;
  for (const std::size_t i : atoms) {
    const Atom& atom = molecule.atoms[i];
    if (is_hydrogen(atom)) continue;
    if (!std::isfinite(atom.b_factor)) {
      known.is_rebuilt = known.is_rebuilt || atom.name != "OXT";
      continue;
    }
    const double b = static_cast<double>(atom.b_factor);
    of_any = std::fmax(of_any, b);
    if (!is_backbone(atom.name)) largest = std::fmax(largest, b);
    known.occupancy = std::min(known.occupancy, static_cast<double>(atom.occupancy));
    known.has_alternates = known.has_alternates || atom.has_alternates;
  }
  if (median > 0) known.relative_b = (std::isfinite(largest) ? largest : of_any) / median;
  return known;
}

/// What both states of a residue look like, atom by atom.
struct Moves {
  double all = kNaN, backbone = kNaN;  ///< rms, Angstrom
  bool same_charges = true;
};

/// [source residue] from the paired atoms.
std::vector<Moves> moves_of_residues(const ComparedResidues& c, const ResidueAtoms& source,
                                     const ResidueAtoms& target) {
  struct Sums {
    double all = 0, backbone = 0;
    std::size_t n = 0, n_backbone = 0;
    bool same_charges = true;
  };
  constexpr float kSameCharge = 0.01F;
  const bool charged = !c.source.charges.empty() && !c.target.charges.empty();
  std::vector<Sums> sums(c.source.residues.size());
  for (const auto& [s, t] : c.pairing.pairs) {
    Sums& of = sums[static_cast<std::size_t>(c.source.atoms[s].residue)];
    const Vec3d d = c.source_to_target.apply(c.source.positions[s]) - c.target.positions[t];
    of.all += dot(d, d);
    ++of.n;
    if (is_backbone(c.source.atoms[s].name)) {
      of.backbone += dot(d, d);
      ++of.n_backbone;
    }
    if (charged && std::fabs(c.source.charges[s] - c.target.charges[t]) > kSameCharge) of.same_charges = false;
  }
  std::vector<Moves> moves(sums.size());
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const Sums& of = sums[r];
    if (of.n > 0) moves[r].all = std::sqrt(of.all / static_cast<double>(of.n));
    if (of.n_backbone > 0) moves[r].backbone = std::sqrt(of.backbone / static_cast<double>(of.n_backbone));
    const bool same_atoms = c.target_of[r] >= 0 && of.n == source[r].size() &&
                            of.n == target[static_cast<std::size_t>(c.target_of[r])].size();
    moves[r].same_charges = of.same_charges && same_atoms;
  }
  return moves;
}

std::string turn_in_words(const ChiTurn& turn) {
  return "chi " + std::to_string(turn.chi) + " by " + formatted("%.0f", turn.angle) + " degrees";
}

/// Sets kind and detail of a residue that pairs, by where its charges are.
void set_motion(const Moves& moves, const ChiTurn& turn, ResidueChange& change) {
  const bool turned = turn.chi > 0 && turn.angle > kTurnedAngle;
  if (moves.backbone > kMovedBackbone_A) {
    change.kind = CauseKind::kBackbone;
    change.detail = "backbone by " + formatted("%.1f", moves.backbone) + " A";
    if (turned) change.detail += ", " + turn_in_words(turn);
  } else if (turned) {
    change.kind = CauseKind::kSideChain;
    change.detail = turn_in_words(turn);
  } else if (moves.all > kMovedAtoms_A) {
    change.kind = CauseKind::kMoved;
    change.detail = "by " + formatted("%.1f", moves.all) + " A";
  }
}

/// Where the states of protonation, or the ends of the chain, differ.
bool set_protonation(const ComparedResidues& c, ResidueChange& change) {
  for (const ProtonationDifference& d : c.protonation) {
    if (static_cast<std::int32_t>(d.source) != change.source) continue;
    const auto is_end = [](const std::string& state) { return state.find("-terminus") != std::string::npos; };
    change.kind = is_end(d.source_state) || is_end(d.target_state) ? CauseKind::kTerminus : CauseKind::kProtonation;
    change.detail = d.source_state + " to " + d.target_state;
    return true;
  }
  return false;
}

void set_kind(const ComparedResidues& c, ResidueKind kind, const Moves& moves, const ChiTurn& turn,
              ResidueChange& change) {
  const bool both = change.source >= 0 && change.target >= 0;
  const std::string only = both ? "" : change.source >= 0 ? "only in the source" : "only in the target";
  if (kind == ResidueKind::kOther || kind == ResidueKind::kWater) {
    change.kind = CauseKind::kLigand;
    change.detail = only;
    return;
  }
  if (!both) {
    change.kind = CauseKind::kUnpaired;
    change.detail = only;
    return;
  }
  const std::string &a = c.source.residues[static_cast<std::size_t>(change.source)].name,
                    &b = c.target.residues[static_cast<std::size_t>(change.target)].name;
  if (!same_residue_name(a, b)) {
    change.kind = CauseKind::kSubstituted;
    change.detail = a + " to " + b;
  } else if (set_protonation(c, change)) {
  } else if (!moves.same_charges) {
    change.kind = CauseKind::kCharges;
  } else if (change.in_source.is_rebuilt || change.in_target.is_rebuilt) {
    change.kind = CauseKind::kRebuilt;
    change.detail = std::string("in the ") + (!change.in_source.is_rebuilt   ? "target"
                                              : !change.in_target.is_rebuilt ? "source"
                                                                             : "source and the target");
  } else {
    set_motion(moves, turn, change);
  }
}

}  // namespace

bool PlaceKnowledge::is_poor() const {
  return relative_b > kPoorRelativeB || occupancy < 1 || has_alternates || is_rebuilt;
}

bool knows_places(const Molecule& molecule) { return std::isfinite(median_b(molecule)); }

std::vector<ResidueChange> residue_changes(const ComparedResidues& c) {
  const ResidueAtoms source = atoms_of_residues(c.source), target = atoms_of_residues(c.target);
  const std::vector<ResidueKind> source_kinds = residue_kinds(c.source, source),
                                 target_kinds = residue_kinds(c.target, target);
  const std::vector<Moves> moves = moves_of_residues(c, source, target);
  const double source_b = median_b(c.source), target_b = median_b(c.target);
  std::vector<bool> is_paired(c.target.residues.size(), false);
  std::vector<ResidueChange> changes;
  for (std::size_t r = 0; r < c.source.residues.size(); ++r) {
    ResidueChange change;
    change.source = static_cast<std::int32_t>(r);
    change.target = c.target_of[r];
    change.residue = c.source.residues[r];
    change.moved_A = moves[r].all;
    change.in_source = knowledge_of(c.source, source[r], source_b);
    ChiTurn turn;
    if (change.target >= 0) {
      const auto t = static_cast<std::size_t>(change.target);
      is_paired[t] = true;
      change.in_target = knowledge_of(c.target, target[t], target_b);
      turn = chi_turn(c.source, source[r], c.target, target[t], kTurnedAngle);
    }
    set_kind(c, source_kinds[r], moves[r], turn, change);
    changes.push_back(std::move(change));
  }
  for (std::size_t t = 0; t < c.target.residues.size(); ++t) {
    if (is_paired[t]) continue;
    ResidueChange change;
    change.target = static_cast<std::int32_t>(t);
    change.residue = c.target.residues[t];
    change.moved_A = kNaN;
    change.in_target = knowledge_of(c.target, target[t], target_b);
    set_kind(c, target_kinds[t], {}, {}, change);
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace espdiff
