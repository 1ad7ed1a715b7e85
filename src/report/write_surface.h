// write_surface.h: one molecule's surface as a .vtp file.
#pragma once

#include <string>

#include "base/types.h"

namespace espdiff {

class AtomicFile;
struct SurfaceResult;

/// Point arrays: normal, component, residue_number (0 where no atom reaches) and, with a map, potential (NaN outside
/// the map).
/// @param unit of the potential; the file says where it is in vacuum
/// @throws IoError; then nothing is written
/// The first form leaves it to the caller to commit.
void write_surface(AtomicFile& file, const Molecule& molecule, const SurfaceResult& result, PotentialUnit unit);
void write_surface(const std::string& path, const Molecule& molecule, const SurfaceResult& result, PotentialUnit unit);

}  // namespace espdiff
