// ion_table.h: charges and radii of ions of one atom.
#pragma once

#include <optional>
#include <string>

namespace espdiff {

struct IonParameters {
  int charge = 0;     ///< elementary charges
  double radius = 0;  ///< Angstrom
};

/// An ion by the name of its residue, which may say the oxidation state (FE2, CU1, 3CO), otherwise by its element in
/// its most common state in proteins. Radii are half the distance of the energy's minimum in Amber's Lennard-Jones
/// parameters for TIP3P, as the radii of Amber's atoms in PDB2PQR: alkali ions and halides Joung and Cheatham, J. Phys.
/// Chem. B 112, 9020 (2008); divalent ions the compromise set of Li, Roberts, Chakravorty and Merz, J. Chem. Theory
/// Comput. 9, 2733 (2013); ions of three and four charges Li, Song and Merz, J. Phys. Chem. B 119, 883 (2015); Cu(I),
/// Ag(I) and Tl(I) the same, J. Chem. Theory Comput. 11, 1645 (2015). Hydroxide (OH) has oxygen's element_radius().
/// @param element of its atom, in any case
/// @returns nothing for an element that is not in the table
std::optional<IonParameters> ion_parameters(const std::string& residue_name, const std::string& element);

}  // namespace espdiff
