// field.cpp: fields whose values are those of atoms.
#include "field/field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "align/residue_names.h"
#include "base/error.h"

namespace espdiff {

FieldKind kind_of_atoms(Quantity quantity, std::string help, std::string reference,
                        std::function<std::vector<float>(const Molecule&)> values) {
  FieldKind kind{std::move(quantity), "", std::move(help), std::move(reference), nullptr};
  kind.field = [values = std::move(values)](const FieldKind& self, const std::string&) {
    Field field{self.quantity, self.quantity.name, self.reference, nullptr};
    field.make = [values, label = self.quantity.label](const Molecule& molecule, const FieldSide& side) {
      StateField of_state;
      of_state.atoms = values(molecule);
      if (std::none_of(of_state.atoms.begin(), of_state.atoms.end(), [](float v) { return std::isfinite(v); }))
        throw InputError("the " + std::string(to_string(side)) + " (" + molecule.name + ") has none of the field '" +
                         label + "', so that the states cannot be compared by it; leave the field out, or give a " +
                         "structure that has it");
      return of_state;
    };
    return field;
  };
  return kind;
}

FieldKind kind_of_potential(Quantity quantity, std::string help, SurfaceReader reader) {
  FieldKind kind{std::move(quantity), "", std::move(help), "the states' potentials", nullptr};
  kind.field = [reader = std::move(reader)](const FieldKind& self, const std::string&) {
    Field field{self.quantity, self.quantity.name, "", nullptr};
    field.make = [reader](const Molecule&, FieldSide) {
      StateField of_state;
      of_state.on_surface = reader;
      return of_state;
    };
    field.of_potential = true;
    return field;
  };
  kind.needs_charges = true;
  return kind;
}

bool is_hydrogen(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

void give_to_hydrogens(const Molecule& molecule, std::vector<float>& values) {
  const std::vector<float> given = values;
  for (const std::vector<std::size_t>& residue : atoms_of_residues(molecule)) {
    for (const std::size_t h : residue) {
      if (!is_hydrogen(molecule.atoms[h]) || std::isfinite(given[h])) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::size_t a : residue) {
        if (is_hydrogen(molecule.atoms[a]) || !std::isfinite(given[a])) continue;
        const double distance = norm(molecule.positions[a] - molecule.positions[h]);
        if (distance >= nearest) continue;
        nearest = distance;
        values[h] = given[a];
      }
    }
  }
}

}  // namespace espdiff
