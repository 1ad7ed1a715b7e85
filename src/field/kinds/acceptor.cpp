// acceptor.cpp: the field of hydrogen bond acceptors.
#include "field/field.h"
#include "field/hydrogen_bonds.h"

namespace espdiff {

FieldKind acceptor_kind() {
  return kind_of_atoms({"acceptor", "Hydrogen bond acceptors", "", false},
                       "Share of the density around a point that is of hydrogen bond acceptors; needs hydrogens",
                       "Arunan et al., Definition of the hydrogen bond, Pure Appl. Chem. 83, 1637 (2011)", acceptors);
}

}  // namespace espdiff
