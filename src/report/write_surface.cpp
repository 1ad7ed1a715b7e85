// write_surface.cpp: one molecule's surface as a .vtp file.
#include "report/write_surface.h"

#include "base/units.h"
#include "io/files/atomic_file.h"
#include "io/vtk/write_vtp.h"
#include "mapping/build_surface.h"
#include "mapping/map_recipe.h"

namespace espdiff {

void write_surface(AtomicFile& file, const Molecule& molecule, const SurfaceResult& result, PotentialUnit unit) {
  std::vector<std::int32_t> residue_numbers;
  for (const std::int32_t residue : result.residue) {
    residue_numbers.push_back(residue >= 0 ? molecule.residues[static_cast<std::size_t>(residue)].number : 0);
  }
  const std::vector<std::int32_t> component(result.mesh.component.begin(), result.mesh.component.end());

  VtpSurface surface;
  surface.points = VtpArray("points", result.positions);
  surface.triangles = &result.mesh.triangles;
  surface.point_arrays = {
      {"normal", result.mesh.normals}, {"component", component}, {"residue_number", residue_numbers}};
  surface.active_normals = "normal";
  if (!result.potential.empty()) {
    surface.point_arrays.emplace_back("potential", result.potential);
    surface.active_scalars = "potential";
    surface.texts = {{"potential_unit", std::string(to_string(unit)) + (result.is_vacuum ? kInVacuum : "")}};
  }
  write_vtp(file.stream(), surface);
}

void write_surface(const std::string& path, const Molecule& molecule, const SurfaceResult& result, PotentialUnit unit) {
  AtomicFile file(path);
  write_surface(file, molecule, result, unit);
  file.commit();
}

}  // namespace espdiff
