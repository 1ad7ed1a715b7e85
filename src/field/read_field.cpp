// read_field.cpp: the three ways in which a field is made, at the vertices of a surface.
#include "field/read_field.h"

#include "align/geometry/superpose.h"
#include "engine/engine.h"

namespace espdiff {

std::vector<float> read_field(const StateField& field, const FieldPlace& place) {
  if (field.on_surface) return field.on_surface(place);
  if (field.map != nullptr) {
    const GridPtr map = place.engine.upload_map(*field.map, inverse(place.to_common));
    return place.engine.download(place.engine.sample(map, place.outside));
  }
  AtomValues atoms;
  atoms.values = field.atoms;
  atoms.weight = field.weight;
  for (const Vec3d& p : place.molecule.positions) atoms.positions.push_back(place.to_common.apply(p));
  for (const float radius : place.molecule.radii)
    atoms.widths.push_back(static_cast<float>(place.radius_scale * static_cast<double>(radius)));
  return place.engine.atom_field(place.mesh, atoms);
}

}  // namespace espdiff
