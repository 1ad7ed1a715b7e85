// residues.cpp: fields of residues' values from tables.
#include "field/field_files.h"

namespace espdiff {

FieldKind residues_kind() {
  FieldKind kind{{"residues", "Values of residues", "", true},
                 "FILE.csv[,TARGET.csv]",
                 "Values of residues from a table, such as conservation, mutational scans, hydrogen exchange: a CSV "
                 "file with the columns chain, residue_number and value, for both states or one for each",
                 "",
                 nullptr};
  kind.field = [](const FieldKind& self, const std::string& argument) {
    return field_of_tables(self, argument, false);
  };
  return kind;
}

}  // namespace espdiff
