// side_maps.h: both sides' potentials on the device, given or computed, in one unit.
#pragma once

#include "base/handles.h"
#include "mapping/input.h"

namespace espdiff {

/// Whether this side has a potential.
inline bool has_map(const CompareInput& side) { return side.map != nullptr || side.make_map != nullptr; }

/// @throws InputError (a map on one side only; units that differ with one unknown)
void check_maps(const CompareInput& source, const CompareInput& target);

/// The unit of the comparison: that of a computed map if there is one, otherwise the source's.
PotentialUnit common_unit(const CompareInput& source, const CompareInput& target);
/// The unit of one side's map.
PotentialUnit unit_of(const CompareInput& side);

/// The side's map, computed or uploaded, in a unit; its recipe counts where it was computed.
/// @param to_map the common frame -> the molecule's own
/// @param request of a computed one
/// @param unit   kUnknown leaves a given map's values as they are
/// @throws as CompareInput::make_map; InputError (units that cannot be converted)
MadeMap device_map(Engine& engine, const CompareInput& side, const RigidTransform& to_map, const MapRequest& request,
                   PotentialUnit unit, double temperature_K, const Progress& progress);

/// Number of samples outside the map.
/// @param counts [sample] whether to include it; empty includes all
/// @throws InputError if all of the surface lies outside
std::size_t count_outside(const CompareInput& side, const std::vector<float>& samples,
                          const std::vector<bool>& counts = {});

}  // namespace espdiff
