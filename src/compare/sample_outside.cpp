// sample_outside.cpp: moves vertices along their normals, samples there, and finds what lies inside the surface.
#include "compare/sample_outside.h"

#include "engine/engine.h"

namespace espdiff {

OutsideSamples sample_outside(Engine& engine, const GridPtr& map, const MeshPtr& mesh, const AtomsPtr& atoms,
                              float isovalue, double offset_A) {
  OutsideSamples samples;
  if (offset_A == 0) {
    samples.values = engine.download(engine.sample(map, mesh));
    samples.inside.assign(samples.values.size(), 0);
    return samples;
  }
  std::vector<Vec3f> points = engine.download(mesh).positions;
  const std::vector<Vec3f> normals = engine.level_set_normals(mesh, atoms, isovalue);
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = points[v] + static_cast<float>(offset_A) * normals[v];
  samples.values = engine.download(engine.sample(map, engine.with_positions(mesh, points)));
  for (const float density : engine.density_at(atoms, points)) samples.inside.push_back(density > isovalue ? 1 : 0);
  return samples;
}

}  // namespace espdiff
