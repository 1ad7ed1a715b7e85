// complementarity.cpp: the local electrostatic complementarity at an interface.
#include "base/error.h"
#include "field/field.h"
#include "field/interface_request.h"

namespace espdiff {

/// A study of two complexes makes it (study/pair_interface.h), since it takes charges that the compared molecule lacks.
FieldKind complementarity_kind() {
  FieldKind kind{{kComplementarity, "Electrostatic complementarity", "", true},
                 "",
                 "Minus the product of both partners' potentials at an interface, each less its mean and over its "
                 "standard deviation there; `interface` names the partners. Its mean is the complementarity",
                 "McCoy, Epa and Colman, Electrostatic complementarity at protein/protein interfaces, 1997",
                 nullptr};
  kind.field = [](const FieldKind& self, const std::string&) {
    Field field{self.quantity, self.quantity.name, self.reference, nullptr};
    field.make = [](const Molecule&, const FieldSide& side) {
      if (side.input.complementarity == nullptr)
        throw InputError("it is made of two partners in a comparison of two complexes, which " +
                         option("interface", "A:B") + " names; other studies have no complementarity");
      return *side.input.complementarity;
    };
    return field;
  };
  kind.needs_charges = true;
  return kind;
}

}  // namespace espdiff
