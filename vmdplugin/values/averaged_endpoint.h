// averaged_endpoint.h: a potential that was averaged over frames, as an endpoint's map.
#pragma once

#include <string>

#include "endpoint.h"
#include "tcl_values.h"

namespace espdiff::vmdplugin {

/// Makes the volume in memory the endpoint's computed potential: the mean of PME over the frames around the endpoint's.
/// @param reader mean_over N, charges LIST (of the frame), ?water B?, ?name TEXT?, ?because TEXT?, settings of PME
/// @throws InputError
void take_averaged_map(DictReader& reader, const std::string& volume, const std::string& role, State& state);

}  // namespace espdiff::vmdplugin
