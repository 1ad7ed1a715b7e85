// elements.h: van der Waals radii by element, and elements guessed from atom names.
#pragma once

#include <string>

namespace espdiff {

/// Van der Waals radius by element, Angstrom. Bondi, J. Phys. Chem. 68, 441 (1964); elements he does not give: Alvarez,
/// Dalton Trans. 42, 8617 (2013). `element` in any case; 1.7 for unknown (empty) ones.
float element_radius(const std::string& element);

/// Guesses the element from a PDB-style atom name and its residue ("CA" in ALA is carbon, "CA" in CA calcium).
std::string element_from_atom_name(const std::string& atom_name, const std::string& residue_name);

}  // namespace espdiff
