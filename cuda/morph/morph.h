// morph.h: a surface carried from source to target by the level sets of moving atoms' density.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

struct MovingSurface;

/// The surface at the start: no motion, no removed triangle.
MovingSurface start_surface(const SurfaceMesh& mesh);

/// See Engine::morph().
MorphResult morph(const SurfaceMesh& mesh, const std::vector<MovingAtom>& atoms, const AtomCells& source_atoms,
                  const AtomCells& target_atoms, const MorphOptions& options, const std::string& stage,
                  const Progress& progress);

/// See Engine::continue_morph().
MorphResult continue_morph(const MorphResult& so_far, const std::vector<MovingAtom>& atoms,
                           const AtomCells& source_atoms, const AtomCells& target_atoms, const MorphOptions& options,
                           const std::string& stage, const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
