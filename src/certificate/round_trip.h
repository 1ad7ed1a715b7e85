// round_trip.h: the round-trip error of a mapping.
#pragma once

#include "base/handles.h"
#include "certificate/result.h"
#include "mapping/mapping.h"

namespace espdiff {

/// Takes each matched vertex to the target by `there` and back by `back`, an independent mapping from the target's
/// surface to the source's, and measures how far from its start it ends. Skips vertices where the mapping back has lost
/// the surface.
/// @throws GeometryError if no vertex is left
RoundTrip measure_round_trip(Engine& engine, const Mapping& there, const Mapping& back);

}  // namespace espdiff
