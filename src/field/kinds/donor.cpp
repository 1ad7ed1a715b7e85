// donor.cpp: the field of hydrogen bond donors.
#include "field/field.h"
#include "field/hydrogen_bonds.h"

namespace espdiff {

FieldKind donor_kind() {
  return kind_of_atoms({"donor", "Hydrogen bond donors", "", false},
                       "Share of the density around a point that is of hydrogen bond donors; needs hydrogens",
                       "Arunan et al., Definition of the hydrogen bond, Pure Appl. Chem. 83, 1637 (2011)", donors);
}

}  // namespace espdiff
