// confidence.cpp: the field of a predicted model's confidence.
#include "field/field.h"

namespace espdiff {

/// Predictors write the confidence in the place of the B factor.
FieldKind confidence_kind() {
  return kind_of_atoms({"confidence", "Confidence (pLDDT)", "", false},
                       "Confidence of predicted models, which stands where others have the B factor",
                       "Jumper et al., Highly accurate protein structure prediction with AlphaFold, Nature 596, 583 "
                       "(2021)",
                       [](const Molecule& m) {
                         std::vector<float> values;
                         for (const Atom& atom : m.atoms) values.push_back(atom.b_factor);
                         give_to_hydrogens(m, values);
                         return values;
                       });
}

}  // namespace espdiff
