// atoms.cpp: fields of atoms' values from tables.
#include "field/field_files.h"

namespace espdiff {

FieldKind atoms_kind() {
  FieldKind kind{{"atoms", "Values of atoms", "", true},
                 "FILE.csv[,TARGET.csv]",
                 "Values of atoms from a table, such as computed shieldings or fluctuations: a CSV "
                 "file with the columns chain, residue_number, atom_name and value, for both states or one for each",
                 "",
                 nullptr};
  kind.field = [](const FieldKind& self, const std::string& argument) { return field_of_tables(self, argument, true); };
  return kind;
}

}  // namespace espdiff
