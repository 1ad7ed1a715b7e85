// map_by_morph.h: what a morph needs of a comparison's options, and its result as a mapping.
#pragma once

#include "engine/morph_stage.h"
#include "mapping/mapping.h"

namespace espdiff {

struct CompareOptions;

/// The morph's options with the isovalue and the longest edge that follow from the surface's.
MorphOptions morph_options(const CompareOptions& options);

/// Downloads what the later stages need on the host.
Mapping mapping_of(Engine& engine, const MorphResult& morphed);

}  // namespace espdiff
