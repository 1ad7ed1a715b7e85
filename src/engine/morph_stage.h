// morph_stage.h: parameters and results of the morph, and the paths of its atoms.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/screw.h"
#include "base/vector.h"
#include "engine/handles.h"

namespace espdiff {

/// An atom's way from the source to the target, in a straight line, for Engine::morph(). Common frame, Angstrom.
struct MovingAtom {
  Vec3d start{}, end{};
  Screw motion{};                         ///< of the rigid domain that it belongs to; its own way is straight beside it
  Vec3d own_rotation{};                   ///< of its surroundings beside the domain's motion: axis times angle, radians
  double start_width = 0, end_width = 0;  ///< standard deviation of its Gaussian; 0 counts as absent
  /// Atoms without a counterpart are absent at one end. They appear and vanish in the half of the way that lies at that
  /// end.
  bool at_start = true, at_end = true;

  Vec3d position_at(double time) const { return motion.apply(start + time * own_path(), time); }
  Vec3d velocity_at(double time) const { return motion.velocity_at(position_at(time)) + motion.turn(own_path(), time); }
  /// Angular velocity of its surroundings.
  Vec3d spin_at(double time) const { return motion.angle * motion.axis + motion.turn(own_rotation, time); }
  /// From where it starts to where it would end if its domain stood still.
  Vec3d own_path() const { return motion.apply(end, -1) - start; }

  static constexpr double kFadingShare = 0.5;
  /// Share of the Gaussian that is there at a time from 0 (source) to 1 (target).
  double weight_at(double time) const {
    const double appeared = at_start ? 1.0 : std::min(1.0, time / kFadingShare);
    const double left = at_end ? 1.0 : std::min(1.0, (1.0 - time) / kFadingShare);
    return std::min(appeared, left);
  }
  /// Its derivative; at a kink that of the later side.
  double weight_rate_at(double time) const {
    if (!at_start && time < kFadingShare) return 1.0 / kFadingShare;
    if (!at_end && time >= 1.0 - kFadingShare) return -1.0 / kFadingShare;
    return 0.0;
  }
};

/// Parameters of morph(). Lengths in Angstrom.
struct MorphOptions {
  double isovalue = 0.5;
  double max_step_A = 0.35;  ///< no atom moves farther in one step
  double max_edge_A = 1.4;   ///< longer edges are halved
  double max_stretch = 20;   ///< where an edge to be halved has grown by more the surface counts as torn
};

struct MorphReport {
  int steps = 0;
  std::size_t n_vertices_added = 0;
  std::size_t n_vertices_unmatched = 0;  ///< without counterpart
};

/// What morph() gives: meshes of one topology, that of the source with some edges halved.
struct MorphResult {
  MeshPtr source;  ///< where each vertex comes from, on the source's surface
  MeshPtr mapped;  ///< where it lies on the target's
  /// [triangle] 1 where the surface was torn or crushed on the way, so that there is no counterpart; the mapped
  /// positions there mean nothing.
  ScalarsPtr unmatched;
  ScalarsPtr path_length;  ///< [vertex] length of its way, Angstrom; an added vertex begins with its ends' mean
  MorphReport report;
};

}  // namespace espdiff
