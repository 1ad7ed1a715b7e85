// choose_potential.h: which potential is computed where none is named.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "potential/potential.h"

namespace espdiff {

/// What a molecule brings for a potential.
struct PotentialFacts {
  std::string name;  ///< for messages
  bool has_charges = false;
  bool has_solvent = false;  ///< charged water, in a periodic cell
};

/// @param everything the molecule with its water and ions, whatever part has the surface
PotentialFacts potential_facts(const Molecule& everything, const std::optional<UnitCell>& cell);
/// Whether some atom's charge is not 0.
bool has_charges(const Molecule& molecule);

struct PotentialChoice {
  std::optional<PotentialMethod> method;  ///< none: shapes alone are compared
  bool own_cell = false;                  ///< of pme: the molecule's own cell, with water and ions
  std::string because;                    ///< why, where it was not asked for
};

/// The potential for molecules that are compared with each other.
///
/// What is asked for is taken. `auto` takes pme where every molecule has charged water in a periodic cell, else pb
/// where every molecule has charges, else none: a potential in vacuum is nobody's default.
/// @param asked auto, none, pme, coulomb or pb
/// @param cell  of pme: own, box, or auto, which takes the molecules' own cells where all have water in one
/// @throws InputError for other words; when a potential was asked for and a molecule has no charges
PotentialChoice choose_potential(const std::string& asked, const std::string& cell,
                                 const std::vector<PotentialFacts>& molecules);

}  // namespace espdiff
