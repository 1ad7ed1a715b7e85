// map_pair.h: the potential maps of both sides, so that a picture can look them up at every pixel.
#pragma once

#include <memory>
#include <string>

#include "base/types.h"
#include "view/run_record.h"
#include "view/surface_file.h"

namespace espdiff {

/// Both maps in the unit of the comparison, or why there are none.
struct MapPair {
  std::shared_ptr<const Grid> source, target;
  std::string why_not;  ///< empty when there are maps

  bool complete() const { return source != nullptr && target != nullptr; }
};

/// Reads the maps that a comparison used. They are taken only when they are the same: by their fingerprints, and by the
/// potentials that the comparison sampled from them, which must come out again within 1e-3 of their range at (nearly)
/// every vertex.
/// Never throws for maps that are missing, changed or unreadable: pictures are then drawn between the vertices' values,
/// and say so.
MapPair read_map_pair(const RunRecord& record, const SurfaceFile& surface);

}  // namespace espdiff
