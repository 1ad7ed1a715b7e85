// components.h: connected components of a mesh.
#pragma once

#include <vector>

#include "cuda/surface/mesh/mesh.h"
#include "engine/surface_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

struct ComponentLabels {
  Buffer<std::uint32_t> label;  ///< [vertex] component, numbered in order of first vertex
  std::size_t n_components = 0;
};

/// Waits once, for the number of components.
ComponentLabels label_components(const SurfaceMesh& mesh);

std::vector<ComponentSummary> summarize_components(const SurfaceMesh& mesh, const ComponentLabels& labels);

/// The mesh of the components with `keep` true; vertices and triangles keep their order.
std::shared_ptr<SurfaceMesh> keep_components(const SurfaceMesh& mesh, const ComponentLabels& labels,
                                             const std::vector<bool>& keep);

}  // namespace espdiff::ESPDIFF_BACKEND
