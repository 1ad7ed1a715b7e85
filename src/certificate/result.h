// result.h: the result of a comparison: metrics, certificate, residues and the mapped surface.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/molecule/pairing.h"
#include "base/types.h"
#include "certificate/trusted_area.h"
#include "certificate/uncovered_surface.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/morph_stage.h"
#include "field/field_patches.h"
#include "field/field_result.h"
#include "mapping/start_from.h"
#include "mapping/surface_summary.h"
#include "motions/alignment.h"

namespace espdiff {

struct Causes;
struct InterfaceComparison;
struct MapCheck;
struct MapRecipe;
struct PatchPlacement;

/// Per-residue averages over the trusted mapped surface, source residues. Area-weighted; NaN if a residue has none. The
/// slip is that of all matched surface, since what slipped is not trusted.
struct ResidueRow : ResidueMeans {
  std::size_t residue = 0;  ///< index into the source's residues
  double mean_displacement_A = 0;
  double mean_path_length_A = 0;
  double mean_slip_A = 0;            ///< NaN if no atom of the residue has a partner
  double slip_area_fraction = 0;     ///< farther than kLargeSlip_A
  double own_difference = 0;         ///< of the residue's potentials on its own surfaces; see set_own_differences()
  double own_area_A2 = 0;            ///< of these surfaces
  double matched_area_A2 = 0;        ///< of matched mapped surface that is not corrupt
  double trusted_area_fraction = 0;  ///< of its surface on the source; NaN if it has none
};

/// Slip beyond these is medium, and large: a side chain's width, and the distance between neighbouring residues.
constexpr double kMediumSlip_A = 2, kLargeSlip_A = 3;

/// Slip of the matched area, weighted by the mapped area; see Engine::slip(). NaN where the atoms do not pair.
struct SlipSummary {
  double mean_A = 0, median_A = 0, p95_A = 0, max_A = 0;
  double medium_area_fraction = 0, large_area_fraction = 0;  ///< beyond kMediumSlip_A, kLargeSlip_A
  double unpaired_area_fraction = 0;                         ///< of atoms without a partner, so without a slip
};

/// The differences by residue against those of each residue's potentials on its own surfaces, which need no mapping.
struct ResidueCheck {
  double correlation = 0;    ///< NaN if it is not defined
  double rms_error = 0;      ///< of the mapped differences, in the unit of the potential
  double rms_potential = 0;  ///< of the source's own potentials
  std::size_t n_residues = 0;
  std::size_t n_disagreeing = 0;  ///< residues left out: see disagreeing_residues()
};

/// Round-trip error: how far from its start a vertex ends after mapping to the target and back by a second mapping,
/// made independently from the target. Angstrom, weighted by the source's area.
struct RoundTrip {
  double mean_A = 0, p95_A = 0, max_A = 0;
  double unmatched_target_area_fraction = 0;  ///< of the target's surface, by the mapping back
};

/// The mapping that was not kept where a pair was mapped twice; see choose_motions.h.
struct OtherMapping {
  std::string because;           ///< why the kept one was kept
  std::string domains;           ///< as MappingReport::domains
  std::vector<Message> reasons;  ///< the limits of fit and slip that it exceeds
  double slip_area_fraction = 0, same_residue_area_fraction = 0;
  double unmatched_source = 0, unmatched_target = 0;
  double own_residue_area_fraction = 0;  ///< see own_residue_share()
};

/// What the mapping removed of itself, as shares of the source's area by the first reason that holds: surface torn or
/// crushed on the way, and triangles at its end that intersect, are flipped, corrupt, farther than 1 A from the target,
/// or have grown more than tenfold.
struct RemovedArea {
  double torn = 0, intersecting = 0, flipped = 0, corrupt = 0, far = 0, grown = 0;
};

/// How well the matched part of the mapping fits the target. With the morph, corrupt, flipped and intersecting
/// triangles become unmatched (see find_matched_part()), so unmatched_source measures its quality. target_to_mapped
/// covers all of the target's surface; its mean_within_limit excludes unmatched parts.
struct Certificate {
  double corrupt_area_fraction = 0;
  double flipped_area_fraction = 0;
  double irregularity_A = 0;
  std::size_t self_intersecting_pairs = 0;  ///< see Engine::self_intersections()
  DistanceSummary mapped_to_target;
  DistanceSummary target_to_mapped;
  /// Fraction of the source's area that the mapping lost or moved farther than 1 A from the target.
  double unmatched_source = 0;
  double unmatched_target = 0;  ///< fraction of the target's area farther than 1 A from the mapped surface
  DistortionReport distortion;
  std::optional<RoundTrip> round_trip;
  std::optional<SlipSummary> slip;       ///< empty if no atoms pair
  std::optional<ResidueCheck> residues;  ///< empty without potentials or pairs
  /// Fraction of the mapped area whose residue on the target (of highest density) is paired with its residue on the
  /// source; NaN if no residues pair.
  double same_residue_area_fraction = 0;
  RemovedArea removed;
  /// Whether corrupt, flipped and intersecting triangles were removed, so that these numbers cannot be other than 0.
  bool zero_by_construction = false;
  double outside_maps = 0;  ///< fraction of the mapped area at vertices outside a map
  bool converged = false;
  TrustedArea trusted;
  TurnedArea turned;
  std::vector<std::string> untrusted_parts;  ///< by name, largest first
  bool trustworthy = false;                  ///< on the trusted area; see verdict_of()
  std::vector<Message> reasons;              ///< why not trustworthy
  std::vector<std::string> not_checked;      ///< names of the checks that were not made
};

/// Per-vertex arrays of the mapped surface.
struct MappedSurface {
  std::vector<Vec3d> positions;         ///< [vertex] in the target's own frame
  std::vector<Vec3d> source_positions;  ///< [vertex] in the source's own frame (regularized, not superposed)
  std::vector<Vec3f> normals;           ///< [vertex] outward, of the target's analytic surface; target's frame
  std::vector<Vec3f> source_normals;    ///< [vertex] of the source's; source's frame
  std::vector<Triangle> triangles;
  std::vector<float> potential_source, potential_target;  ///< [vertex]; empty without maps; NaN outside a map
  /// [vertex] from the superposed source, or with rigid domains from the position its domain moves it to; NaN if
  /// unmatched
  std::vector<float> displacement;
  /// [vertex] path length from the start of the mapping, at least the displacement; NaN if unmatched
  std::vector<float> path_length;
  std::vector<float> slip;  ///< [vertex] Angstrom; NaN if unmatched or without partner; empty if no atoms pair
  std::vector<std::int32_t> residue;  ///< [vertex] index of the source residue, -1 for none
  std::vector<std::int32_t>
      target_residue;                 ///< [vertex] index of the target residue where it is mapped to, -1 for none
  std::vector<std::uint8_t> corrupt;  ///< [triangle]
  /// [triangle] nonzero if unmatched: the mapped positions there are meaningless; empty if all are matched.
  std::vector<std::uint8_t> unmatched;
  std::vector<std::uint8_t> why;     ///< [triangle] Why it is not trusted, 0 where it is
  std::vector<std::uint8_t> turned;  ///< [vertex] Turn of what it is on, where it lies off; see turned_atoms()
};

/// [triangle] Areas in the molecules' own frames, A^2: what many sums of a result have as weights.
struct SurfaceAreas {
  std::vector<double> source;  ///< before the mapping; empty where the surface has no such positions
  std::vector<double> mapped;
};

/// The metrics at one distance outside the surfaces.
struct OffsetMetrics {
  double offset_A = 0;
  Metrics metrics;  ///< over trusted triangles
  /// Vertices left out since they lie inside the source's, the target's surface there.
  std::size_t n_inside_source = 0, n_inside_target = 0;
  std::size_t n_outside_source_map = 0, n_outside_target_map = 0;  ///< vertices
};

/// Something about the inputs that a reader must know before the numbers.
struct Warning {
  Message text;
  bool refuses = false;  ///< whether no result of these inputs is trustworthy
};

/// What was found out about the two states before they were mapped.
struct InputReport {
  std::vector<Warning> warnings;       ///< those of later stages come last
  std::vector<ComparedChains> chains;  ///< which were compared with which
  /// Chains that repeat one sequence, by name.
  std::vector<std::vector<std::string>> source_copies, target_copies;
  /// Between charged molecules: residues whose protonation makes a difference by itself.
  std::vector<ProtonationDifference> protonation;
  /// Lines of the printed table on where charges and radii came from: label, text.
  std::vector<std::pair<std::string, std::string>> lines;
  std::string shapes_because;  ///< why there are no potentials, where nobody asked for shapes alone
};

/// Where both potentials came from.
struct ComparedMaps {
  std::shared_ptr<const MapRecipe> source_recipe, target_recipe;  ///< of potentials that were computed, otherwise null
  std::shared_ptr<const MapCheck> source_check, target_check;     ///< of given maps; null where not checked
};

/// How the source's surface was mapped onto the target's.
struct MappingReport {
  StartFrom start = StartFrom::kSource;  ///< where the mapping started
  /// The value of the setting `domains` that it followed: with `as-needed`, `none` or `local`.
  std::string domains = "none";
  DeformReport regularize, deform;
  VectorFlowReport flow;                  ///< of the fields gvf and gvf2
  std::size_t n_vertices_subdivided = 0;  ///< added by deform with `subdivide`
  MorphReport morph;
  std::optional<OtherMapping> other;  ///< empty if the pair was mapped once
};

/// The potentials' difference over one surface.
struct PotentialComparison {
  bool compared = false;  ///< whether there are potentials; nothing else holds without
  PotentialUnit unit = PotentialUnit::kUnknown;
  std::vector<OffsetMetrics> by_offset;                            ///< [offset of the options]
  Metrics metrics;                                                 ///< over trusted triangles
  Metrics metrics_all;                                             ///< over all triangles with samples
  std::size_t n_outside_source_map = 0, n_outside_target_map = 0;  ///< vertices
};

/// What is measured of a surface: the whole one, its region, or a patch.
struct MeasuredSurface {
  double rmsd_A = 0;                              ///< of its paired atoms, after the superposition of the whole
  SurfaceSummary source_surface, target_surface;  ///< of a part, the areas only
  double area_mapped_A2 = 0;
  int n_steps = 0;  ///< of the morph, or iterations of deform
  PotentialComparison potential;
  Certificate certificate;
  std::vector<ResidueRow> residues;
  std::vector<FieldResult> fields;  ///< besides the potential, in the order of the request
};

/// A region or patch, without vertices. The round trip, slip and the correlation by residue are not checked for it
/// alone.
struct PartResult : MeasuredSurface {
  std::string name;                                   ///< kRegionPart, or the patch's
  std::shared_ptr<const PatchPlacement> placement{};  ///< of an earlier patch: how its place was found
};

/// The whole comparison, by the stages that return each member.
struct CompareResult : MeasuredSurface {
  Alignment alignment;
  InputReport inputs;
  ComparedMaps maps;
  MappingReport mapping;
  MappedSurface surface;
  UncoveredSurface uncovered;               ///< of the target
  std::vector<FieldPatches> field_patches;  ///< in the order of the request
  std::vector<PartResult> parts;            ///< the region, if there is one, then the patches as requested
  std::shared_ptr<const Causes> causes{};   ///< which charges make the readings that were asked for; null without any
  std::shared_ptr<const InterfaceComparison> interface {};  ///< null unless one was asked for
  std::vector<std::pair<std::string, double>> time_ms;      ///< stage, in order; "total" last
};

}  // namespace espdiff
