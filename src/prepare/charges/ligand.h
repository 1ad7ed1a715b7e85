// ligand.h: which residues a MOL2 file describes, and their hydrogens.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.h"
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

}  // namespace espdiff
