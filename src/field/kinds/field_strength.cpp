// field_strength.cpp: the magnitude of the electric field.
#include "engine/engine.h"
#include "field/field.h"

namespace espdiff {

FieldKind field_strength_kind() {
  return kind_of_potential({"field-strength", "Electric field strength", "kT/e/A", false},
                           "Magnitude of the electric field, |grad potential|, where the potential is read",
                           [](const FieldPlace& place) {
                             std::vector<float> values;
                             for (const Vec3f& gradient : place.engine.sample_gradient(place.potential, place.outside))
                               values.push_back(norm(gradient));
                             return values;
                           });
}

}  // namespace espdiff
