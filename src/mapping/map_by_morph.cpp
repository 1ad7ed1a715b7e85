// map_by_morph.cpp: a morph's options and its mapping.
#include "mapping/map_by_morph.h"

#include "engine/engine.h"
#include "options/options.h"

namespace espdiff {

MorphOptions morph_options(const CompareOptions& options) {
  MorphOptions morph = options.morph;
  morph.isovalue = options.surface.isovalue;
  morph.max_edge_A = options.morph_max_edge * options.surface.grid_spacing_A;
  return morph;
}

Mapping mapping_of(Engine& engine, const MorphResult& morphed) {
  Mapping mapping;
  mapping.source = morphed.source;
  mapping.mapped = morphed.mapped;
  mapping.unmatched = engine.download(morphed.unmatched);
  mapping.path_length = engine.download(morphed.path_length);
  return mapping;
}

}  // namespace espdiff
