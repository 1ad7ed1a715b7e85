// curvature.cpp: the mean curvature of the surface.
#include "engine/engine.h"
#include "field/field.h"

namespace espdiff {

FieldKind curvature_kind() {
  FieldKind kind{
      {"curvature", "Mean curvature", "1/A", true},
      "",
      "Mean curvature of the surface: 1/r on a sphere, positive where it bulges, negative in pockets",
      "Goldman, Curvature formulas for implicit curves and surfaces, Comput. Aided Geom. Des. 22, 632 (2005)",
      nullptr};
  kind.field = [](const FieldKind& self, const std::string&) {
    Field field{self.quantity, self.quantity.name, self.reference, nullptr};
    field.make = [](const Molecule&, FieldSide) {
      StateField of_state;
      of_state.on_surface = [](const FieldPlace& place) {
        return place.engine.level_set_curvature(place.mesh, place.atoms, place.isovalue);
      };
      return of_state;
    };
    return field;
  };
  return kind;
}

}  // namespace espdiff
