// morph_stage.h: parameters and results of the morph, and the paths of its atoms.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/handles.h"
#include "base/molecule/screw.h"
#include "base/vector.h"

namespace espdiff {

/// An atom's path from source to target for Engine::morph(). Common frame, Angstrom.
struct MovingAtom {
  Vec3d start{}, end{};
  Screw motion{};                         ///< of its rigid domain; its own path is straight relative to that
  Vec3d own_rotation{};                   ///< of its surroundings relative to the domain: axis times angle, radians
  double start_width = 0, end_width = 0;  ///< standard deviation of its Gaussian; 0 counts as absent
  /// Unpaired atoms are absent at one end. They fade in or out in the half of the path at that end.
  bool at_start = true, at_end = true;
  /// The pair that it belongs to: its own, or that of its anchor if it is unpaired; -1 for none.
  std::int32_t pair = -1;

  Vec3d position_at(double time) const { return motion.apply(start + time * own_path(), time); }
  Vec3d velocity_at(double time) const { return motion.velocity_at(position_at(time)) + motion.turn(own_path(), time); }
  /// Angular velocity of its surroundings.
  Vec3d spin_at(double time) const { return motion.angle * motion.axis + motion.turn(own_rotation, time); }
  /// From its start to its end with its domain held fixed.
  Vec3d own_path() const { return motion.apply(end, -1) - start; }

  static constexpr double kFadingShare = 0.5;
  /// Fraction of the Gaussian present at a time from 0 (source) to 1 (target).
  double weight_at(double time) const {
    const double appeared = at_start ? 1.0 : std::min(1.0, time / kFadingShare);
    const double left = at_end ? 1.0 : std::min(1.0, (1.0 - time) / kFadingShare);
    return std::min(appeared, left);
  }
  /// Its derivative; at a kink the derivative of the later side.
  double weight_rate_at(double time) const {
    if (!at_start && time < kFadingShare) return 1.0 / kFadingShare;
    if (!at_end && time >= 1.0 - kFadingShare) return -1.0 / kFadingShare;
    return 0.0;
  }
};

/// Parameters of morph(). Lengths in Angstrom.
struct MorphOptions {
  double isovalue = 0.5;
  double max_step_A = 0.35;  ///< maximum movement of an atom per step
  double max_edge_A = 1.4;   ///< longer edges are split
  double max_stretch = 20;   ///< the surface counts as torn where an edge to be split has grown by more
};

struct MorphReport {
  int steps = 0;
  std::size_t n_vertices_added = 0;
  std::size_t n_vertices_unmatched = 0;  ///< unmatched
};

/// Result of morph(): meshes of one topology, that of the source with some edges split.
struct MorphResult {
  MeshPtr source;  ///< each vertex on the source's surface
  MeshPtr mapped;  ///< each vertex on the target's surface
  /// [triangle] 1 if unmatched because the surface was torn or crushed; the mapped positions there are meaningless.
  ScalarsPtr unmatched;
  ScalarsPtr path_length;  ///< [vertex] path length, Angstrom; an added vertex starts with the mean of its edge's ends
  MorphReport report;
};

}  // namespace espdiff
