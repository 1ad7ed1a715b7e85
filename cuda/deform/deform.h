// deform.h: the deformable surface: external force along a field's gradient, internal force along the surface.
#pragma once

#include "base/progress.h"
#include "cuda/surface/density/grid.h"
#include "cuda/surface/mesh/mesh.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::deform(). Each iteration reads the previous iteration's positions, so the result does not depend on the
/// number of threads.
/// @throws InputError (parameters out of range), GeometryError (rest shape of another topology), Cancelled
std::shared_ptr<SurfaceMesh> deform(const SurfaceMesh& mesh, const SurfaceMesh& rest_mesh, const SurfaceField& field,
                                    const DeformOptions& options, const std::string& stage, const Progress& progress,
                                    DeformReport* report);

struct DeformState;
struct Iteration;

/// Sets the steps of the iteration's forces.
void set_steps(Iteration& it, const DeformOptions& options);

/// Iterates until the mean displacement falls below the limit or the maximum number of iterations is reached. The
/// result is in `positions`. Reports progress, and may throw Cancelled, at checks.
void iterate_one_by_one(DeformState& state, const DeformOptions& options, const std::string& stage,
                        const Progress& progress, DeformReport& report);

}  // namespace espdiff::ESPDIFF_BACKEND
