// causes.h: which residues' charges make a difference of potentials, and what changed about each of them.
//
// A computed potential is a sum over charges, and so is each reading of it. What a residue adds to a difference is what
// its charges add to the target's reading less what they add to the source's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// What changed about a residue; the first that holds, in this order.
enum class CauseKind {
  kSubstituted,
  kLigand,  ///< a residue of no chain: ligand, cofactor, ion
  kUnpaired,
  kProtonation,
  kTerminus,
  kCharges,  ///< charged otherwise for another reason, such as another force field
  kRebuilt,  ///< atoms that the preparation placed
  kBackbone,
  kSideChain,    ///< turned
  kMoved,        ///< otherwise
  kSurroundings  ///< the same charges in the same place
};
constexpr CauseKind kCauseKinds[] = {CauseKind::kSubstituted, CauseKind::kLigand,      CauseKind::kUnpaired,
                                     CauseKind::kProtonation, CauseKind::kTerminus,    CauseKind::kCharges,
                                     CauseKind::kRebuilt,     CauseKind::kBackbone,    CauseKind::kSideChain,
                                     CauseKind::kMoved,       CauseKind::kSurroundings};
/// The word in files: "substituted".
const char* to_string(CauseKind kind);

/// How well a structure file knows where a residue is.
struct PlaceKnowledge {
  double relative_b = 0;  ///< largest B factor of its side chain over the molecule's median; NaN if unknown
  double occupancy = 1;   ///< the least
  bool has_alternates = false;
  bool is_rebuilt = false;  ///< the file lacks heavy atoms of it

  bool is_poor() const;
};

/// Beyond these a place counts as moved: the error of a good crystal structure's atoms, and of a side chain's angle.
constexpr double kMovedBackbone_A = 1, kMovedAtoms_A = 0.5, kTurnedAngle = 30;
/// A B factor of so many times the molecule's median is that of a place poorly known.
constexpr double kPoorRelativeB = 2;

/// A residue of either state, or all residues of one name that are not compared (water, ions).
struct ResidueChange {
  std::int32_t source = -1, target = -1;  ///< residues; -1 where a state has none
  Residue residue;                        ///< the source's, or else the target's
  std::size_t n_residues = 1;             ///< of the larger state, of those that are not compared
  CauseKind kind = CauseKind::kSurroundings;
  std::string detail;  ///< in words: "ASP to GLY", "chi 3 by 113 degrees"; may be empty
  double moved_A = 0;  ///< rms of its paired atoms after the superposition; NaN without any
  PlaceKnowledge in_source, in_target;

  /// "LYS 118", with the chain where there are several: "LYS 118 A"; "water" by its name.
  std::string name(bool with_chain) const;
  bool is_poorly_known() const { return in_source.is_poor() || in_target.is_poor(); }
};

/// What one residue adds to a reading, kT/e.
struct Contribution {
  std::size_t change = 0;  ///< index into Causes::changes
  double source = 0, target = 0;
  double distance_A = 0;  ///< from its nearest atom to the reading's surface; NaN for residues not compared

  double difference() const { return target - source; }
};

/// How a reading would shift if one residue's charges changed, with the shape and all other charges kept, kT/e; NaN in
/// a state that lacks the residue.
struct ScannedResidue {
  std::size_t change = 0;
  double distance_A = 0;
  double removed_source = 0, removed_target = 0;  ///< without its charges
  /// With one elementary charge more at its charges' centre; one less shifts by the opposite.
  double plus_source = 0, plus_target = 0;

  double largest() const;  ///< the size of the largest shift
};

/// How far the placements of one side chain shift the reading of its state, kT/e.
struct SideChainShift {
  std::size_t change = 0;
  bool of_target = false;
  std::vector<std::vector<double>> angles{};  ///< [placement][dihedral angle] degrees; the file's first
  std::vector<double> shifts{};               ///< [placement]
  std::size_t n_refused = 0;                  ///< of the grid, since they clash

  double least() const;
  double most() const;
};

/// The difference with side chains in other places; for means of differences, not of their sizes.
struct PlacementInterval {
  std::size_t n_draws = 0;
  std::uint64_t seed = 0;
  bool is_exact = false;        ///< at the same points; otherwise to first order, with the solute's shape kept
  double low = 0, high = 0;     ///< 2.5 % and 97.5 % of the draws
  double mean = 0, sd = 0;      ///< of the draws
  std::vector<double> draws{};  ///< [draw] the difference
  std::vector<SideChainShift> side_chains{};  ///< the largest range first

  bool spans_zero() const { return low < 0 && high > 0; }
};

struct CausesOfReading {
  std::string name;                             ///< as it was asked for: "patch site"
  double source = 0, target = 0;                ///< kT/e, as sampled
  double sum_of_source = 0, sum_of_target = 0;  ///< of the contributions
  std::vector<Contribution> contributions;      ///< by size of the difference, the largest first
  std::vector<ScannedResidue> scan{};           ///< by size of the largest shift; empty unless asked for
  std::optional<PlacementInterval> placements{};

  double difference() const { return target - source; }
};

struct Causes {
  std::vector<ResidueChange> changes;
  std::vector<CausesOfReading> readings;
  bool knows_places = false;  ///< whether a structure file says how well it knows the atoms' places
  bool has_chains = false;    ///< more than one
};

/// The difference that the residues of a kind make.
struct KindSum {
  CauseKind kind = CauseKind::kSurroundings;
  double difference = 0;
  std::vector<const Contribution*> contributions;  ///< the largest first
};
/// By size, the largest first; only kinds that occur.
std::vector<KindSum> sums_by_kind(const Causes& causes, const CausesOfReading& reading);
/// The part of the difference that residues make whose place is poorly known.
KindSum poorly_known(const Causes& causes, const CausesOfReading& reading);

/// What the charges of one state add, by residue.
struct ResidueSums {
  std::vector<double> of_residue;  ///< [residue of the compared molecule]
  /// Of residues that are not compared, by name: sum and number.
  std::map<std::string, std::pair<double, std::size_t>> of_others;
  double all = 0;
};
/// @param charges       whose charges made the potential; residues of the same name, chain and number are the
/// molecule's
/// @param contributions [atom of `charges`]
ResidueSums sum_by_residue(const Molecule& molecule, const Molecule& charges, const std::vector<double>& contributions);

/// One state of a reading.
struct StateReading {
  const Molecule& molecule;           ///< as it is compared
  const Molecule& charges;            ///< whose charges made the potential
  std::vector<double> contributions;  ///< [atom of `charges`]
  std::vector<Vec3d> surface;         ///< the reading's vertices, in the molecule's frame
  double reading = 0;                 ///< as sampled
};

/// Adds a reading's causes. Charges of residues that are not compared are summed by the residue's name.
void add_reading(Causes& causes, const std::string& name, const StateReading& source, const StateReading& target);

}  // namespace espdiff
