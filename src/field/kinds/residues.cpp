// residues.cpp: fields of residues' values from tables.
#include <memory>

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
    const SideFiles files(self.quantity.name, argument);
    const auto source = std::make_shared<const ValueTable>(files.of(FieldSide::kSource), false);
    const auto target =
        files.is_one() ? source : std::make_shared<const ValueTable>(files.of(FieldSide::kTarget), false);
    Field field{self.quantity, "", "", nullptr};
    field.make = [source, target](const Molecule& molecule, FieldSide side) {
      return (side == FieldSide::kSource ? source : target)->values_of(molecule, side);
    };
    field.files = files.with_sums();
    return field;
  };
  return kind;
}

}  // namespace espdiff
