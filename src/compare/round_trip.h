// round_trip.h: how near there and back comes to where it began.
#pragma once

#include "compare/mapping.h"
#include "compare/result.h"
#include "engine/handles.h"

namespace espdiff {

/// Takes each vertex that has a counterpart there by `there` and back by `back`, a mapping from the target's surface to
/// the source's that was made on its own, and measures how far from its start it ends. Where the way back has lost the
/// surface nothing is measured.
/// @throws GeometryError when that is everywhere
RoundTrip measure_round_trip(Engine& engine, const Mapping& there, const Mapping& back);

}  // namespace espdiff
