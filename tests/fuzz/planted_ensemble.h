// planted_ensemble.h: a small ensemble's file: a tetrahedron, two groups of one replicate of two frames each, of which
// three are written.
#pragma once

#include <string>

#include "../ensemble/planted_plan.h"
#include "ensemble/file/ensemble_file.h"

namespace espdiff_fuzz {

inline espdiff::EnsemblePlan planted_plan() {
  espdiff::EnsemblePlan plan = espdiff_test::plan_of("a tetrahedron", {"ALA 1"});
  plan.charges = {{"wild", "a.pqr"}};
  for (const char* const group : {"wild", "mutant"}) plan.replicates.push_back({group, "1", {"f"}, {group}, 2});
  return plan;
}

inline void plant_ensemble(const std::string& path) {
  espdiff::TemplateSurface surface;
  surface.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  surface.normals = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  surface.residue = {0, 0, 0, 0};
  espdiff::EnsembleFile::create(path, planted_plan(), surface);
  espdiff::EnsembleFile file(path, true);
  for (std::size_t f = 0; f < 3; ++f) file.write(f, {1, 2, 3, 4}, {0.5, 0, 0, 0.1, 1, 2.5, true, "a note"});
}

}  // namespace espdiff_fuzz
