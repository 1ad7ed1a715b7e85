// mapping.h: the result of a mapping on the device, and its matched part.
#pragma once

#include <cstdint>
#include <vector>

#include "base/handles.h"
#include "engine/certificate_stage.h"

namespace espdiff {

/// A vertex farther than this from the other surface is unmatched.
constexpr double kMatchLimit_A = 1.0;

/// Where the area grows by more than this factor, a patch of the source would stand for a much larger one of the
/// target, such as the rim of a contact for the faces that met there; it is unmatched. Shrinking is harmless, since
/// metrics weight by the mapped area.
constexpr double kAreaRatioLimit = 10;

/// Why a triangle was removed from the mapping; the first that holds.
enum class Removal : std::uint8_t { kNone, kTorn, kIntersecting, kFlipped, kCorrupt, kFar, kGrown };

/// Two meshes of one topology: each vertex on the source, and its position on the target.
struct Mapping {
  MeshPtr source, mapped;
  /// [triangle] nonzero if unmatched; empty if the method does not report it.
  std::vector<float> unmatched;
  std::vector<Removal> removed_for;  ///< [triangle] set by find_matched_part(); empty if the method removes nothing
  std::vector<float> path_length;    ///< [vertex] Angstrom

  // The matched part, and how well it fits the target; see find_matched_part().
  MeshPtr matched_source, matched;
  FitReport fit;
  IntersectionReport intersections;
  DistanceSummary to_target;    ///< from `matched` to the target's surface
  DistortionReport distortion;  ///< of `matched` against `matched_source`
};

/// Finds the matched part and measures its fit. If the method reports unmatched triangles (`unmatched` not empty),
/// triangles also become unmatched that are off the target's density, flipped, self-intersecting, far from the target's
/// surface (such as on a closed cavity), or stretched beyond kAreaRatioLimit.
void find_matched_part(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target,
                       float isovalue);

/// The part of a mapping that lies inside, measured like the whole: without `mapped`, `unmatched` and `path_length`.
/// `source` is null where nothing of the mesh is inside, `matched` and `matched_source` where nothing of that is
/// matched.
/// @param outside [triangle] nonzero where it does not belong to the part
Mapping part_of_mapping(Engine& engine, const Mapping& mapping, const std::vector<float>& outside,
                        const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue);

/// A mesh without triangles; null where nothing is left.
/// @param excluded [triangle] nonzero where it is left out
MeshPtr what_is_left(Engine& engine, const MeshPtr& mesh, const std::vector<float>& excluded);

/// Removes the source's closed cavities where they are unmatched; any part that remains has opened.
void drop_closed_cavities(Engine& engine, Mapping& mapping);

/// The same without the distances of single points, which would stay on the device as long as the result.
DistanceSummary numbers_of(DistanceSummary summary);

/// [triangle of the full mesh] from [triangle of the matched part]; 0 if unmatched.
std::vector<std::uint8_t> to_full_mesh(const std::vector<float>& matched, const std::vector<float>& unmatched);

}  // namespace espdiff
