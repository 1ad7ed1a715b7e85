// map_pair.h: the potential maps of both sides, for lookups at every pixel.
#pragma once

#include <memory>
#include <string>

#include "base/types.h"
#include "io/structures/run_record.h"
#include "scene/surface_file.h"

namespace espdiff {

/// Both maps in the unit of the comparison, or the reason for none.
struct MapPair {
  std::shared_ptr<const Grid> source, target;
  std::string why_not;  ///< empty if there are maps

  bool complete() const { return source != nullptr && target != nullptr; }
};

/// Reads the maps that a comparison used. They are accepted only if they are the same: by SHA-256, and by the
/// potentials that the comparison sampled from them, which must be reproduced within 1e-3 of their range at (nearly)
/// every vertex.
/// Does not throw for maps that are missing, changed or unreadable: pictures then interpolate the vertices' values and
/// say so.
MapPair read_map_pair(const RunRecord& record, const SurfaceFile& surface);

}  // namespace espdiff
