// ensemble_json.h: the record of an ensemble's statistics.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace espdiff {

class EnsembleFile;
struct EnsembleResult;

/// Keys: version, plan, options, design, groups, replicates, area_A2, test, noise_floor, patches, equilibrium,
/// warnings.
nlohmann::ordered_json ensemble_json(const EnsembleFile& file, const EnsembleResult& result);

}  // namespace espdiff
