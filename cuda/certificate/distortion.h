// distortion.h: how much a mapping stretches and compresses the surface.
#pragma once

#include "cuda/surface/mesh/mesh.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::distortion().
DistortionReport distortion(const SurfaceMesh& source, const SurfaceMesh& mapped, double limit);

}  // namespace espdiff::ESPDIFF_BACKEND
