// mapping.h: what a mapping gave, on the device, and its part that has a counterpart.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/certificate_stage.h"
#include "engine/handles.h"

namespace espdiff {

/// A vertex farther than this from the other surface has no counterpart there.
constexpr double kCounterpartLimit_A = 1.0;

/// Where the area around a place has grown by more than this, a patch of the source would stand for a much larger one
/// of the target, such as the rim of a contact for the faces that met there: it has no counterpart. What shrinks is no
/// such danger, since metrics weigh by the mapped area.
constexpr double kAreaRatioLimit = 10;

/// Two meshes of one topology: where each vertex comes from, and where it lies on the target.
struct Mapping {
  MeshPtr source, mapped;
  /// [triangle] nonzero where there is no counterpart; empty where the method does not tell.
  std::vector<float> unmatched;
  std::vector<float> path_length;  ///< [vertex] length of its way, Angstrom

  // What has a counterpart, and how well it fits the target; see settle().
  MeshPtr counted_source, counted;
  FitReport fit;
  IntersectionReport intersections;
  DistanceSummary to_target;    ///< from `counted` to the target's surface
  DistortionReport distortion;  ///< of `counted` against `counted_source`
};

/// Finds what has a counterpart, and how well that fits. Where the method tells what is lost (`lost` not empty), what
/// is off the target's density, flipped, intersects itself, lies far from the target's surface (on a closed cavity,
/// say) or is stretched beyond all measure is lost as well.
void settle(Engine& engine, Mapping& mapping, const AtomsPtr& target_atoms, const MeshPtr& target, float isovalue);

/// Leaves out the source's closed cavities where they found no counterpart: what is left of them has opened.
void drop_closed_cavities(Engine& engine, Mapping& mapping);

/// [triangle of the whole] from [triangle with a counterpart]; 0 where lost.
std::vector<std::uint8_t> spread(const std::vector<float>& counted, const std::vector<float>& unmatched);

}  // namespace espdiff
