// trusted_area.h: where a comparison can be trusted: a reason for each triangle that it cannot, their sums, and names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"
#include "base/not_a_number.h"
#include "base/types.h"

namespace espdiff {

struct Certificate;
struct MappedSurface;
struct PotentialComparison;
struct SurfaceAreas;
struct ResidueRow;

/// Why a triangle is not trusted; the first that holds. The numbers stand in OUT.vtp (`why`).
enum class Why : std::uint8_t {
  kTrusted = 0,
  kUnmatched = 1,  ///< it has no place on the target
  kCorrupt = 2,    ///< its place is not on the target's surface (only with deform)
  kUnpaired = 3,   ///< its residue has no partner
  kSlipped = 4,    ///< it slipped by more than kLargeSlip_A
  /// Two of its corners lie off the paired residue: on one that does not touch it, or farther than kBorder_A from what
  /// belongs to the paired atoms.
  kOtherResidue = 5,
  /// Its residue's mapped difference is not that of the residue's potentials on its own surfaces; see
  /// disagreeing_residues().
  kDisagrees = 6,
  kNoPotential = 7,  ///< a corner lies outside a map, or inside the surface where potentials are read outside it
  kTurned = 8        ///< two of its corners are on what turned and lie off; see why_of_mapping()
};
constexpr std::size_t kNumberOfWhys = 9;

/// The key in OUT.json: "slipped".
const char* key_of(Why why);

/// Of a point on a residue that touches its own: a fifth of the lattice's spacing.
constexpr double kBorder_A = 0.2;
/// From this share of both surfaces on, a result is trustworthy as a whole.
constexpr double kWholeShare = 0.95;

/// Shares of the area of the source's whole surface and of the target's.
struct TrustedArea {
  double source = 0, target = 0;
  std::array<double, kNumberOfWhys> by_why{};  ///< of the source's area, by Why

  /// The smaller of the two, by which verdicts are given; NaN without surface.
  double share() const { return source < target || source != source ? source : target; }
};

/// Trusted area on side chains that turned about their bonds, farther than kLargeSlip_A from where they carried it, and
/// within kFarTurn_A unless kAll are kept (turned_side_chains.h). There the mapping finds the residue, but another of
/// its faces, so that a potential is compared with that beside it.
struct TurnedArea {
  double of_trusted = kNaN;                ///< its share of the trusted area of the source; NaN without any
  double mean_abs_difference = kNaN;       ///< over the rest of the trusted area; NaN without potentials or rest
  std::vector<std::string> side_chains{};  ///< "LYS 118 of chain A", that with the largest such area first
};

/// Which points on side chains that turned count as trusted. Those on residues that turned as a whole never do.
enum class KeptTurns : std::uint8_t {
  kAll,   ///< through a template, where the side chains of a simulation turn in every frame
  kNear,  ///< within kFarTurn_A of where the side chain carried them
  kNone
};

/// [triangle] Why, as far as the mapping shows it: all but kDisagrees and kNoPotential.
/// @param surface   with slip, turned (either may be empty) and residues
/// @param target_of [source residue] from paired_residues(); where no residue pairs, residues are not judged
std::vector<std::uint8_t> why_of_mapping(const MappedSurface& surface, const std::vector<std::int32_t>& target_of,
                                         KeptTurns kept = KeptTurns::kNear);

/// Marks the triangles without a potential on either side.
void mark_without_potential(MappedSurface& surface);

/// Marks the triangles with two corners on such residues. @param residues [residue] nonzero to mark
void mark_disagreeing(MappedSurface& surface, const std::vector<std::uint8_t>& residues);

/// [vertex] nonzero where at least half of the triangles around it are trusted.
std::vector<std::uint8_t> trusted_vertices(const MappedSurface& surface);

/// [triangle] nonzero where it is not trusted.
std::vector<float> untrusted_triangles(const MappedSurface& surface);

/// @param outside          [triangle] nonzero where it does not belong to the part; empty for the whole
/// @param unmatched_target of the certificate: the share of the target's area that nothing was mapped to
TrustedArea sum_trusted(const MappedSurface& surface, const SurfaceAreas& areas, const std::vector<float>& outside,
                        double unmatched_target);

/// @param outside [triangle] nonzero where it does not belong to the part; empty for the whole
TurnedArea turned_area(const MappedSurface& surface, const SurfaceAreas& areas, const std::vector<float>& outside,
                       const Molecule& source);

/// The mean absolute difference over the source's whole surface, of which the trusted part is known.
struct WholeSurface {
  /// If the rest of each residue differs like the residue's potentials on its own surfaces, times the ratio of both
  /// over the trusted part.
  double estimate = 0;
  double at_most = 0;  ///< if the rest has the largest difference of a vertex that has both potentials
};
/// NaN without potentials.
WholeSurface whole_surface(const MappedSurface& surface, const std::vector<ResidueRow>& residues,
                           const PotentialComparison& potential);

/// "TRUSTWORTHY", "TRUSTWORTHY ON 83 %" (of the smaller share, rounded down), or "NOT TRUSTWORTHY".
std::string verdict_of(const Certificate& certificate);

}  // namespace espdiff
