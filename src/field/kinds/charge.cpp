// charge.cpp: the field of the atoms' charges.
#include "field/field.h"

namespace espdiff {

FieldKind charge_kind() {
  FieldKind kind =
      kind_of_atoms({"charge", "Charge", "e", true}, "Partial charges of the atoms around a point, their mean",
                    "the charges that the structures have", [](const Molecule& m) { return m.charges; });
  kind.needs_charges = true;
  return kind;
}

}  // namespace espdiff
