// ligand.h: what files say of ligands: hydrogens and charges of MOL2 files, bonds of definitions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "io/structures/read_component.h"
#include "io/structures/read_mol2.h"

namespace espdiff {

/// The MOL2 files among ChargeOptions::ligands. @throws as read_mol2()
std::vector<Mol2File> read_ligands(const std::vector<std::string>& paths);

/// [residue] the first file whose atoms have all names of the residue's heavy atoms; -1 for none, and for amino acids
/// and nucleotides.
std::vector<std::int32_t> ligands_of_residues(const Molecule& molecule, const std::vector<Mol2File>& ligands);

/// Adds to each residue the hydrogens of its file that it lacks, where the file's heavy atoms, superposed on the
/// residue's by name, put them.
/// @param ligand_of [residue] from ligands_of_residues()
/// @throws GeometryError (fewer than 3 heavy atoms, or all in a line), InputError (more than kMostAtoms atoms)
Molecule add_ligand_hydrogens(const Molecule& molecule, const std::vector<Mol2File>& ligands,
                              const std::vector<std::int32_t>& ligand_of);

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
