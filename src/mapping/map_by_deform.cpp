// map_by_deform.cpp: rounds of the force iteration and of subdivision.
#include "mapping/map_by_deform.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "engine/engine.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// Longer edges are split, in grid spacings.
constexpr double kLongestEdge = 1.4;
/// A safety limit: each round splits the edges that the previous one stretched.
constexpr int kMaxRounds = 8;

/// Positions of the new vertices on the source: midpoints of edges, projected onto its isosurface. The others stay.
MeshPtr trace_back(Engine& engine, const MeshPtr& source, std::size_t n_old, const AtomsPtr& atoms,
                   const SurfaceOptions& options) {
  std::vector<Vec3f> positions = engine.download_positions(source);
  const std::vector<Vec3f> projected = engine.download_positions(
      engine.project(source, atoms, static_cast<float>(options.isovalue), kProjectionShare * options.grid_spacing_A));
  std::copy(projected.begin() + static_cast<std::ptrdiff_t>(n_old), projected.end(),
            positions.begin() + static_cast<std::ptrdiff_t>(n_old));
  return engine.with_positions(source, positions);
}

void add(std::vector<float>& sums, const std::vector<float>& values) {
  std::transform(sums.begin(), sums.end(), values.begin(), sums.begin(), [](float a, float b) { return a + b; });
}

}  // namespace

FieldPtr make_field(Engine& engine, const Surface& source, const Surface& target, const CompareOptions& options,
                    const Progress& progress, VectorFlowReport* report) {
  const float isovalue = static_cast<float>(options.surface.isovalue);
  switch (options.field) {
    case DeformField::kDensity: return engine.density_field(target.density, isovalue);
    case DeformField::kDistance:
      return engine.distance_field(target.density, isovalue, target.mesh, options.distance_threshold_A, progress);
    case DeformField::kGvf: return engine.gvf_field(target.density, nullptr, isovalue, options.flow, progress, report);
    case DeformField::kGvf2:
      return engine.gvf_field(target.density, source.density, isovalue, options.flow, progress, report);
  }
  throw Error(ErrorClass::kInternal, "a kind of field without a stage");
}

Mapping map_by_deform(Engine& engine, const Surface& source, const MeshPtr& regularized, const Surface& target,
                      const MeshPtr& start, const DomainMotions& domains, const FieldPtr& field,
                      const CompareOptions& options, const Progress& progress, DeformReport& report,
                      std::size_t& n_added) {
  const double spacing = options.surface.grid_spacing_A;
  DeformOptions iteration = options.deform;
  iteration.min_displacement_A = options.deform_min_displacement * spacing;
  Mapping mapping;
  mapping.source = regularized;
  mapping.mapped = start;
  mapping.path_length.assign(engine.n_vertices(start), 0.0F);
  int n_iterations = 0;
  for (int round = 0; round < kMaxRounds; ++round) {
    mapping.mapped = engine.deform(mapping.mapped, field, iteration, "deform", progress, &report,
                                   domains.carry(engine, mapping.source, source.atoms));
    n_iterations += report.iterations;
    iteration.max_iterations = options.deform.max_iterations - n_iterations;
    add(mapping.path_length, engine.download(report.path_length));
    if (!options.subdivide || !report.converged || round + 1 == kMaxRounds) break;
    const SubdivisionResult halved = engine.subdivide(mapping.source, mapping.mapped, kLongestEdge * spacing);
    if (halved.ends.empty()) break;
    const std::size_t n_old = mapping.path_length.size();
    mapping.source = trace_back(engine, halved.source, n_old, source.atoms, options.surface);
    mapping.mapped = halved.mapped;
    for (const auto& [a, b] : halved.ends)
      mapping.path_length.push_back(0.5F * (mapping.path_length[a] + mapping.path_length[b]));
    n_added += halved.ends.size();
  }
  report.iterations = n_iterations;
  report.path_length = nullptr;
  if (options.surface.project) {
    const MeshPtr projected = engine.project(mapping.mapped, target.atoms, static_cast<float>(options.surface.isovalue),
                                             kProjectionShare * spacing);
    add(mapping.path_length, engine.download(engine.displacement(mapping.mapped, projected)));
    mapping.mapped = projected;
  }
  return mapping;
}

}  // namespace espdiff
