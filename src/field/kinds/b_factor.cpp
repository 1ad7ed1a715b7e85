// b_factor.cpp: the field of the B factors.
#include "field/field.h"

namespace espdiff {

/// Hydrogens that a preparation added take the B factor of their neighbour.
FieldKind b_factor_kind() {
  return kind_of_atoms({"b-factor", "B factor", "A^2", false}, "B factors of the structures' files",
                       "the structures' files", [](const Molecule& m) {
                         std::vector<float> values;
                         for (const Atom& atom : m.atoms) values.push_back(atom.b_factor);
                         give_to_hydrogens(m, values);
                         return values;
                       });
}

}  // namespace espdiff
