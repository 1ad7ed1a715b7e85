// sample_outside.cpp: moves vertices along their normals, samples there, and finds what lies inside the surface.
#include "mapping/sample_outside.h"

#include "engine/engine.h"

namespace espdiff {

MeshPtr moved_outside(Engine& engine, const MeshPtr& mesh, const AtomsPtr& atoms, float isovalue, double offset_A) {
  if (offset_A == 0) return mesh;
  std::vector<Vec3f> points = engine.download(mesh).positions;
  const std::vector<Vec3f> normals = engine.level_set_normals(mesh, atoms, isovalue);
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = points[v] + static_cast<float>(offset_A) * normals[v];
  return engine.with_positions(mesh, points);
}

OutsideSamples sample_outside(Engine& engine, const GridPtr& map, const MeshPtr& mesh, const AtomsPtr& atoms,
                              float isovalue, double offset_A) {
  OutsideSamples samples;
  const MeshPtr outside = moved_outside(engine, mesh, atoms, isovalue, offset_A);
  samples.values = engine.download(engine.sample(map, outside));
  samples.inside.assign(samples.values.size(), 0);
  if (offset_A == 0) return samples;
  const std::vector<float> densities = engine.density_at(atoms, engine.download_positions(outside));
  for (std::size_t v = 0; v < densities.size(); ++v) samples.inside[v] = densities[v] > isovalue ? 1 : 0;
  return samples;
}

}  // namespace espdiff
