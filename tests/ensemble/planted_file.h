// planted_file.h: ensembles whose values are known.
#pragma once

#include <string>
#include <vector>

#include "compare/template_mapping.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/planted_plan.h"
#include "statistics/planted_columns.h"
#include "support/test_data.h"

namespace espdiff_test {

/// Groups "wild" and "mutant"; the template has two residues, of positive and of negative x.
inline espdiff::EnsemblePlan planted_plan(std::size_t n_wild, std::size_t n_mutant, std::size_t n_frames) {
  espdiff::EnsemblePlan plan = plan_of("an ellipsoid", {"ALA 1", "GLY 2"});
  for (std::size_t r = 0; r < n_wild + n_mutant; ++r) {
    const bool wild = r < n_wild;
    const std::string name = std::to_string(wild ? r + 1 : r - n_wild + 1);
    plan.replicates.push_back({wild ? "wild" : "mutant", name, {name}, {std::to_string(r)}, n_frames});
  }
  return plan;
}

inline espdiff::TemplateSurface planted_template(int levels) {
  espdiff::TemplateSurface surface;
  make_ellipsoid(levels, surface.positions, surface.triangles);
  for (const espdiff::Vec3d& p : surface.positions) {
    surface.normals.push_back(static_cast<espdiff::Vec3f>((1 / norm(p)) * p));
    surface.residue.push_back(p.x > 0 ? 0 : 1);
  }
  return surface;
}

/// Fills a file with correlated noise; `effect` is added to the mutants' frames at vertices of residue 0 with y > 8 A.
inline void fill_planted(espdiff::EnsembleFile& file, const espdiff::EnsemblePlan& plan, double effect,
                         std::uint64_t seed) {
  const espdiff::TemplateSurface& surface = file.surface();
  const std::size_t n = surface.positions.size();
  std::size_t frame = 0;
  for (std::size_t r = 0; r < plan.replicates.size(); ++r) {
    const std::size_t n_frames = plan.replicates[r].n_frames;
    std::vector<float> values(n * n_frames);
    for (std::size_t v = 0; v < n; ++v) {
      Normal normal(seed, r * n + v);
      const std::vector<double> series = correlated_series(n_frames, 0.5, normal);
      const bool is_inside = surface.positions[v].x > 0 && surface.positions[v].y > 8;
      const double shift = is_inside && plan.replicates[r].group == "mutant" ? effect : 0;
      for (std::size_t f = 0; f < n_frames; ++f) values[f * n + v] = static_cast<float>(series[f] + shift);
    }
    for (std::size_t f = 0; f < n_frames; ++f, ++frame) {
      const std::vector<float> row(values.begin() + static_cast<std::ptrdiff_t>(f * n),
                                   values.begin() + static_cast<std::ptrdiff_t>((f + 1) * n));
      file.write(frame, row, {1, 0, 0, 0, 1, static_cast<double>(row[0]), true, ""});
    }
  }
}

/// Makes such a file.
inline void plant_file(const std::string& path, const espdiff::EnsemblePlan& plan, double effect, std::uint64_t seed,
                       int levels = 2) {
  espdiff::EnsembleFile::create(path, plan, planted_template(levels));
  espdiff::EnsembleFile file(path, true);
  fill_planted(file, plan, effect, seed);
}

}  // namespace espdiff_test
