// normal_field.cpp: the component of the electric field along the surface's outward normal.
#include "engine/engine.h"
#include "field/field.h"

namespace espdiff {

FieldKind normal_field_kind() {
  return kind_of_potential(
      {"normal-field", "Normal electric field", "kT/e/A", true},
      "Component of the electric field along the outward normal, -d(potential)/dn, where the potential is read; "
      "positive drives positive charges away from the surface",
      [](const FieldPlace& place) {
        std::vector<float> values;
        const std::vector<Vec3f> normals = place.engine.level_set_normals(place.mesh, place.atoms, place.isovalue);
        for (const Vec3f& gradient : place.engine.sample_gradient(place.potential, place.outside))
          values.push_back(-dot(gradient, normals[values.size()]));
        return values;
      });
}

}  // namespace espdiff
