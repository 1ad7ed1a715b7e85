// open_babel.h: hydrogens and charges of a ligand from Open Babel, which is run as a program.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "base/types.h"
#include "prepare/charges/ligand.h"

namespace espdiff {

/// The path of Open Babel: $ESPDIFF_OBABEL, otherwise obabel on PATH; empty where there is none.
std::string find_open_babel();
/// What to do where there is none: "install it (Debian: openbabel)".
extern const char* const kOpenBabelRemedy;

/// For people: where charges of ligands come from on this machine, or what to do about it.
struct LigandSupport {
  bool is_there;
  std::string text;
};
LigandSupport ligand_support();

/// A ligand with Open Babel's hydrogens and charges: its heavy atoms as given, followed by the hydrogens; with radii.
struct ChargedLigand {
  Molecule molecule;  ///< one residue
  std::size_t n_hydrogens_added = 0;
  std::size_t n_hydrogens_replaced = 0;  ///< those of the file, where Open Babel does not keep them
  double net_charge = 0;  ///< elementary charges; the sum over its atoms, whole but for the digits of the file
};

/// Perceives bonds from the distances of heavy atoms where they are not known, adds hydrogens for a pH, and assigns
/// Gasteiger's charges (O'Boyle et al., J. Cheminform. 3, 33 (2011); Gasteiger and Marsili, Tetrahedron 36, 3219
/// (1980)). Radii are by element (element_radius()). Hydrogens that the ligand has are kept where Open Babel takes them
/// as they are, and made anew otherwise. Open Babel says which hydrogens there are, without those that no valence
/// allows, whose charge goes to the atom that they are bound to; place_hydrogens() says where they lie, since Open
/// Babel places some by random numbers. What is wrong in the geometry makes bonds, and so protons, wrong: compare the
/// net charge.
/// @param ligand   one residue
/// @param molecule that it is of, for messages and clashes
/// @param bonds    of its atoms, none of which is a hydrogen; null where they are to be perceived
/// @throws DeviceError (no Open Babel, or it failed), InputError (it returned other atoms than it got), Cancelled
ChargedLigand charge_by_open_babel(const Molecule& ligand, const Molecule& molecule, double ph,
                                   const LigandBonds* bonds, const Progress& progress);

}  // namespace espdiff
