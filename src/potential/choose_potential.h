// choose_potential.h: which potential is computed if the user names none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "potential/potential.h"
#include "potential/potential_settings.h"

namespace espdiff {

/// Facts of a molecule that decide which potential can be computed.
struct PotentialFacts {
  std::string name;  ///< for messages
  bool has_charges = false;
  bool has_solvent = false;  ///< charged water, in a periodic cell
  std::size_t n_waters = 0;  ///< of that solvent: molecules of water, ions of one charge, the sum of their squares
  std::size_t n_ions = 0;
  double ion_squares = 0;
};

/// @param everything the whole molecule with water and ions
PotentialFacts potential_facts(const Molecule& everything, const std::optional<UnitCell>& cell);
/// [atom] Whether it is an ion of salt: a residue of one atom with one elementary charge (or nearly one).
std::vector<bool> salt_ions(const Molecule& molecule);
/// Whether some atom's charge is not 0.
bool has_charges(const Molecule& molecule);

struct PotentialChoice {
  std::optional<PotentialMethod> method;  ///< none: only shapes are compared
  bool own_cell = false;                  ///< of pme: the molecule's own cell, with water and ions
  std::string because;                    ///< the reason, if the user did not ask for it
  /// Of pb in place of explicit water: mol/l, the mean of what the ions of all molecules make in their water.
  std::optional<double> ionic_strength;
};

/// One potential for molecules that are compared with each other.
///
/// `auto` takes pb if every molecule has charges, otherwise none; never a potential in vacuum. Where every molecule has
/// charged water in a periodic cell, a continuum with the salt of its ions takes the water's place, because the water
/// of a single frame says more of that moment than of the molecule. What is averaged over frames takes pme there.
/// @param averaged whether potentials of many frames are averaged
/// @param asked auto, none, pme, coulomb or pb
/// @param cell  of pme: own, box, or auto, which takes the molecules' own cells where all have water in one
/// @throws InputError for other words; when a potential was asked for and a molecule has no charges
PotentialChoice choose_potential(const std::string& asked, const std::string& cell,
                                 const std::vector<PotentialFacts>& molecules, bool averaged = false);

/// What the user gave, with the salt of the choice where no ionic strength is given.
GivenPotentialSettings with_salt(const PotentialChoice& choice, GivenPotentialSettings given);

}  // namespace espdiff
