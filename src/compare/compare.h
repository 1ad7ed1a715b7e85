// compare.h: one pair of molecules from atoms and maps to metrics and certificate; the only code that knows the order
// of the stages.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "align/pair_atoms.h"
#include "align/rigid_domains.h"
#include "base/progress.h"
#include "base/types.h"
#include "engine/engine.h"

namespace espdiff {

/// What draws the surface in `deform`: the target's density, the distance to it where that is far, or gradient vector
/// flow from the target, or from both surfaces.
enum class FieldKind { kDensity, kDistance, kGvf, kGvf2 };
FieldKind parse_field_kind(const std::string& text);
std::string to_string(FieldKind field);
Interpolation parse_interpolation(const std::string& text);

/// How the source's surface is brought onto the target's: by forces in a field of the target (the thesis), or carried
/// by the level sets of the density while the atoms move.
enum class Method { kDeform, kMorph };
Method parse_method(const std::string& text);
std::string to_string(Method method);

/// How a surface is made of a molecule.
struct SurfaceOptions {
  double grid_spacing_A = 1.0;
  double radius_scale = 1.0;
  double isovalue = 0.5;
  bool cavities = false;  ///< keep closed cavities; else they are counted and left out
  bool project = true;    ///< move vertices onto the analytic isosurface
};

/// All parameters of a comparison; defaults are the study's values of the thesis where it has them. Not in the thesis:
/// tangential gains other than 1, the rest shape, the projection onto the exact isosurface, and the mapping's smaller
/// min_displacement.
struct CompareOptions {
  SurfaceOptions surface;
  AlignAtoms align = AlignAtoms::kAll;
  std::string domains = "none";  ///< rigid domains that are aligned by themselves; see check_domains()
  Method method = Method::kMorph;
  MorphOptions morph;
  double morph_max_edge = 1.4;  ///< in grid spacings; sets MorphOptions::max_edge_A
  FieldKind field = FieldKind::kDistance;
  double distance_threshold_A = 0.75;
  VectorFlowOptions flow;
  bool subdivide = false;  ///< halve edges that deform has stretched, and go on; see map_by_deform.h
  DeformOptions regularize{0.1, 0.5, 0.3, 1e-3, 500, Interpolation::kTrilinear, 4, false};
  DeformOptions deform{0.1, 0.75, 0.3, 1e-3, 3000, Interpolation::kTrilinear, 8, true};
  /// In grid spacings; they set min_displacement_A. The thesis' 1e-3 lets the mapping end while a few vertices still
  /// travel.
  double regularize_min_displacement = 1e-3, deform_min_displacement = 5e-4;
  bool round_trip = false;     ///< map back as well, which takes as long again, and see whether that ends at the start
  double temperature_K = 300;  ///< for converting between kT/e and other units
};

/// The thesis' iteration as it stands, for comparing with its results.
CompareOptions thesis_options();

struct SurfaceSummary {
  std::size_t n_vertices = 0;
  std::size_t n_triangles = 0;
  std::size_t n_components = 0;  ///< after leaving out cavities
  std::size_t n_cavities_left_out = 0;
  double area_A2 = 0;
  double cavity_area_A2 = 0;  ///< of the cavities left out
};

/// Per-residue averages over the mapped surface, source residues. Area-weighted; NaN where no valid area.
struct ResidueRow {
  std::size_t residue = 0;  ///< index into the source's residues
  double area_A2 = 0;       ///< of mapped surface that is counted
  double mean_abs_difference = 0;
  double mean_signed_difference = 0;  ///< target - source
  double mean_source = 0;
  double mean_target = 0;
  double sign_change_area_fraction = 0;
  double mean_displacement_A = 0;
  double mean_path_length_A = 0;
};

/// How far from its start a vertex ends that is taken to the target and back by a second mapping, made from the target
/// on its own. Angstrom, weighted by the source's area.
struct RoundTrip {
  double mean_A = 0, p95_A = 0, max_A = 0;
  double unmatched_target_area_fraction = 0;  ///< of the target's surface, by the mapping back
};

/// How well the part of the mapping that has a counterpart fits the target. By the morph corrupt, flipped and
/// intersecting triangles count as without one (see settle()), so that what says how well it went is
/// unmatched_source. target_to_mapped is from all of the target's surface; its mean_within_limit leaves out what
/// has none.
struct Certificate {
  double corrupt_area_fraction = 0;
  double flipped_area_fraction = 0;
  double irregularity_A = 0;
  std::size_t self_intersecting_pairs = 0;  ///< see Engine::self_intersections()
  DistanceSummary mapped_to_target;
  DistanceSummary target_to_mapped;
  /// Share of the source's area that the mapping lost, or that it took farther than 1 A from the target.
  double unmatched_source = 0;
  double unmatched_target = 0;  ///< share of the target's area farther than 1 A from the mapped surface
  DistortionReport distortion;
  std::optional<RoundTrip> round_trip;
  /// Share of the mapped area whose residue (of most density) on the target is the one paired with that on the source;
  /// NaN where no residues pair.
  double same_residue_area_fraction = 0;
  bool converged = false;
  bool trustworthy = false;
  std::vector<std::string> reasons;      ///< why not
  std::vector<std::string> not_checked;  ///< what was not checked
};

/// Per-vertex arrays of the mapped surface.
struct MappedSurface {
  std::vector<Vec3d> positions;         ///< [vertex] in the target's own frame
  std::vector<Vec3d> source_positions;  ///< [vertex] in the source's own frame (regularized, not superposed)
  std::vector<Vec3f> normals;           ///< [vertex] outward, of the target's analytic surface; target's frame
  std::vector<Vec3f> source_normals;    ///< [vertex] of the source's; source's frame
  std::vector<Triangle> triangles;
  std::vector<float> potential_source, potential_target;  ///< [vertex]; empty without maps; NaN outside a map
  /// [vertex] from the source's place, superposed, or with rigid domains from where its domain takes it; NaN where
  /// there is no counterpart
  std::vector<float> displacement;
  /// [vertex] length of its way from where the mapping started, displacement at least; NaN as there
  std::vector<float> path_length;
  std::vector<std::int32_t> residue;  ///< [vertex] index of the source residue, -1 for none
  std::vector<std::uint8_t> corrupt;  ///< [triangle]
  /// [triangle] nonzero where the mapping found no counterpart: the mapped positions there mean nothing; empty where it
  /// found one everywhere.
  std::vector<std::uint8_t> unmatched;
};

/// Where the mapping of a target starts: from the source's surface, or from that of the target before, which is nearer
/// when targets are the frames of a trajectory.
enum class StartFrom { kSource, kPrevious };

struct CompareResult {
  double rmsd_A = 0;
  AtomPairing pairing;
  std::size_t n_superposed_atoms = 0;
  RigidTransform source_to_target;   ///< the superposition
  std::vector<RigidDomain> domains;  ///< aligned by themselves; displacements are from where their motions end
  bool has_potential = false;
  PotentialUnit unit = PotentialUnit::kUnknown;
  Metrics metrics;                                                 ///< over valid triangles
  Metrics metrics_all;                                             ///< over all triangles with samples
  std::size_t n_outside_source_map = 0, n_outside_target_map = 0;  ///< vertices
  SurfaceSummary source_surface, target_surface;
  double area_mapped_A2 = 0;
  Certificate certificate;
  StartFrom start = StartFrom::kSource;  ///< where the mapping started
  DeformReport regularize_report, deform_report;
  VectorFlowReport flow_report;           ///< of the fields gvf and gvf2
  std::size_t n_vertices_subdivided = 0;  ///< added by deform with `subdivide`
  MorphReport morph_report;
  std::vector<ResidueRow> residues;
  MappedSurface surface;
  std::vector<std::pair<std::string, double>> time_ms;  ///< stage, in order, and last "total"
};

/// Makes a potential map where it is needed, on the device: sampled there in whatever way the map was made for, such as
/// by its splines (PmeOptions::smooth_samples). In kT/e at the comparison's temperature. `to_map` is the way from the
/// common frame into the molecule's own, which is the map's.
using MapMaker = std::function<GridPtr(Engine& engine, const RigidTransform& to_map, const Progress& progress)>;

/// One side of a comparison, with a map that is given, or one that is computed, or none. Maps may be absent on both
/// sides: then shapes are compared only.
struct CompareInput {
  const Molecule* molecule = nullptr;
  const Grid* map = nullptr;
  MapMaker make_map = nullptr;  ///< instead of `map`
};

/// What a series hands from one step to the next, all in the source's principal frame. Angstrom.
struct SeriesState {
  std::vector<Vec3f> mapped;  ///< [vertex] the last step's mapped surface
  std::vector<Vec3d> target;  ///< [atom of the source] where the last target's counterpart lay; NaN where there is none

  /// By the morph, whose mesh grows on its way.
  struct Morph {
    std::vector<Vec3f> source;  ///< [vertex] where it comes from
    std::vector<Triangle> triangles;
    std::vector<float> unmatched;    ///< [triangle] nonzero: lost in this step or one before
    std::vector<float> path_length;  ///< [vertex] length of its way so far
    Molecule target;                 ///< the last target
    /// Shares of the source's area without counterpart: on the last target, and where the surface came from the source
    /// last.
    double unmatched_share = 0, unmatched_share_at_start = 0;
  };
  std::optional<Morph> morph;  ///< nothing by the method deform
};

/// Many targets compared with one source, whose surface is made and regularized once, for the first of them, and whose
/// potential is computed once.
class Series {
 public:
  /// Keeps references to all but the options.
  Series(Engine& engine, const CompareInput& source, const CompareOptions& options);
  ~Series();

  /// Compares the source with one target. `start` kPrevious goes on from the last step's mapping; CompareResult::start
  /// says where that was done, and after an error or a cancellation the next step starts from the source.
  ///
  /// By deform, where the last mapping converged and its target lies nearer to this one than the source does (RMSD of
  /// the paired atoms, as superposed). The internal force is measured from the source's shape in both cases.
  ///
  /// By the morph, where the last target lies less than half as far as the source, and the surface has lost at most
  /// 0.5 % of the source's area since it came from there. Its surface then travels on with the atoms from the last
  /// target to this one: the correspondence is composed of small steps. Path lengths add up; edges that were halved
  /// stay halved; what the surface lost on the way stays without counterpart until a step starts from the source again.
  /// What settle() left out beyond that is about one target alone, and not carried on. A surface that starts from the
  /// source again jumps to the counterparts of the direct way.
  /// @throws as compare()
  CompareResult step(const CompareInput& target, StartFrom start, const Progress& progress);

  /// What the next step may start from; nothing when that is the source.
  std::optional<SeriesState> state() const;
  /// Goes on from a state() of an equal series: the next step then gives the same bits as there.
  /// @throws InputError when the state is of another source (told by the numbers of atoms or, at the next step, of
  /// vertices)
  void restore(SeriesState state);

 private:
  struct Steps;
  std::unique_ptr<Steps> steps_;
};

/// Compares two molecules: a series of one.
/// @throws InputError (no common atoms; a map on one side only; a map that misses the surface entirely; units that
/// differ and one
///         unknown), GeometryError, MemoryError, Cancelled
CompareResult compare(Engine& engine, const CompareInput& source, const CompareInput& target,
                      const CompareOptions& options, const Progress& progress);

/// A molecule's surface in its own frame, for the `surface` verb.
struct SurfaceResult {
  Mesh mesh;                          ///< positions in the molecule's frame
  std::vector<Vec3d> positions;       ///< [vertex] double precision, the molecule's frame
  std::vector<std::int32_t> residue;  ///< [vertex]
  std::vector<float> potential;       ///< [vertex], empty without a map
  PotentialUnit unit = PotentialUnit::kUnknown;
  SurfaceSummary summary;
  std::vector<ComponentSummary> components;  ///< all, cavities included
  DeformReport regularize_report;
  std::vector<std::pair<std::string, double>> time_ms;
};
/// @param regularize evens out the triangles, as for the source of a comparison
SurfaceResult make_surface(Engine& engine, const CompareInput& input, const CompareOptions& options, bool regularize,
                           const Progress& progress);

/// A molecule's density on a lattice along the coordinate axes of its own frame: VMD's interpolation (1.9.4) takes no
/// other.
Grid make_density(Engine& engine, const Molecule& molecule, const SurfaceOptions& options);

}  // namespace espdiff
