// choose_potential.h: which potential is computed if the user names none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "potential/potential.h"

namespace espdiff {

/// Facts of a molecule that decide which potential can be computed.
struct PotentialFacts {
  std::string name;  ///< for messages
  bool has_charges = false;
  bool has_solvent = false;  ///< charged water, in a periodic cell
};

/// @param everything the whole molecule with water and ions
PotentialFacts potential_facts(const Molecule& everything, const std::optional<UnitCell>& cell);
/// Whether some atom's charge is not 0.
bool has_charges(const Molecule& molecule);

struct PotentialChoice {
  std::optional<PotentialMethod> method;  ///< none: only shapes are compared
  bool own_cell = false;                  ///< of pme: the molecule's own cell, with water and ions
  std::string because;                    ///< the reason, if the user did not ask for it
};

/// One potential for molecules that are compared with each other.
///
/// `auto` takes pme if every molecule has charged water in a periodic cell; otherwise pb if every molecule has charges;
/// otherwise none. It never takes a potential in vacuum.
/// @param asked auto, none, pme, coulomb or pb
/// @param cell  of pme: own, box, or auto, which takes the molecules' own cells where all have water in one
/// @throws InputError for other words; when a potential was asked for and a molecule has no charges
PotentialChoice choose_potential(const std::string& asked, const std::string& cell,
                                 const std::vector<PotentialFacts>& molecules);

}  // namespace espdiff
