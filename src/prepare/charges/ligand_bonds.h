// ligand_bonds.h: the bonds of a ligand by its definition, which Open Babel would otherwise perceive from distances.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "io/structures/read_component.h"

namespace espdiff {

/// Bonds between the heavy atoms of a ligand, by their places in it.
struct LigandBonds {
  std::vector<ComponentBond> bonds;
  std::vector<int> charges;      ///< [atom] as ComponentAtom::charge
  std::string path = {};         ///< of the file that was given; empty for CCP4's library
  std::string in_words() const;  ///< "FMN.cif", "CCP4's library"
};

/// The components of the files among ChargeOptions::ligands that are no MOL2 files. @throws as read_components()
std::vector<Component> given_components(const std::vector<std::string>& paths);

/// The bonds of a residue by a component of its name, of those given or else of CCP4's library; nothing where there is
/// none, where an atom is not in it, where one that is missing has a double bond, as where another residue is bound in
/// its place, where other atoms are as near to each other as bound ones, or with hydrogens, which say more than a
/// definition.
/// @param fragment  the residue's atoms, and behind them those of its neighbours that stand in for its chain, whose
/// bonds are told by distances
/// @param n_own     how many are the residue's
std::optional<LigandBonds> bonds_by_definition(const Molecule& fragment, std::size_t n_own,
                                               const std::vector<Component>& given);

/// [atom] whether it is the nitrogen of an amidine whose other nitrogen is acylated, as in the chromophore of the green
/// fluorescent protein. It takes a proton below a pH of 3 only, where Open Babel's rule for amidines adds one.
std::vector<bool> acylated_amidines(const Molecule& ligand, const LigandBonds& bonds);

/// The text of an MDL molfile (V2000). @param ligand at most kMostMolfileAtoms atoms
std::string molfile_text(const Molecule& ligand, const LigandBonds& bonds);
constexpr std::size_t kMostMolfileAtoms = 999;

}  // namespace espdiff
