// given.cpp: fields of values that come with the molecule.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "field/field.h"
#include "field/given_values.h"

namespace espdiff {

FieldKind given_kind() {
  FieldKind kind{{"given", "Given values", "", true},
                 "NAME",
                 "Values of atoms that come with the molecule: in VMD what `$sel get NAME` returns, such as user, beta "
                 "or mass; in Python arrays under a name",
                 "",
                 nullptr};
  kind.field = [](const FieldKind& self, const std::string& argument) {
    Field field{self.quantity, "", "", nullptr};
    field.quantity.label = argument;
    field.make = [argument](const Molecule& molecule, const FieldSide& side) {
      const std::string state = "the " + std::string(to_string(side)) + " (" + molecule.name + ")";
      if (side.input.given == nullptr)
        throw InputError(state + " comes without values; the field given:" + argument + " is of molecules in VMD and " +
                         "of arrays in Python, and a file's atoms have theirs in a table (atoms:FILE.csv)");
      StateField of_state;
      of_state.atoms = side.input.given->values_of(argument, molecule);
      if (std::none_of(of_state.atoms.begin(), of_state.atoms.end(), [](float v) { return std::isfinite(v); }))
        throw InputError(state + " has no value in '" + argument +
                         "' that is finite; leave the field out, or give some");
      return of_state;
    };
    return field;
  };
  return kind;
}

}  // namespace espdiff
