// occupancy.cpp: the field of the occupancies.
#include "field/field.h"

namespace espdiff {

FieldKind occupancy_kind() {
  return kind_of_atoms({"occupancy", "Occupancy", "", false}, "Occupancies of the structures' files",
                       "the structures' files", [](const Molecule& m) {
                         std::vector<float> values;
                         for (const Atom& atom : m.atoms) values.push_back(atom.occupancy);
                         return values;
                       });
}

}  // namespace espdiff
