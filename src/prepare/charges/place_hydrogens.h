// place_hydrogens.h: where the hydrogens of a ligand lie, from its heavy atoms and bonds.
#pragma once

#include <vector>

#include "base/types.h"
#include "io/structures/read_mol2.h"

namespace espdiff {

/// Drops added hydrogens that no valence allows: at carbon and nitrogen beyond four bonds, at oxygen beyond two, such
/// as on a quaternary ammonium, where a rule for amines adds one. Their charges go to the atoms that they are bound to.
/// @param n_given the first atoms are given, the others are added hydrogens
void drop_impossible_hydrogens(Mol2File& ligand, std::vector<Mol2Bond>& bonds, std::size_t n_given);

/// Places added hydrogens by ideal geometry: standard lengths (neutron diffraction; Allen et al., J. Chem. Soc. Perkin
/// Trans. 2, S1 (1987)), tetrahedral, trigonal or linear by the type of the atom that they are bound to. Methyl and
/// ammonium groups are staggered. Hydroxyl, thiol and imine hydrogens take, of their two or three rotations, the one
/// that points to an oxygen within 2.5 Angstrom, otherwise the one that is farthest from all atoms. Where that puts a
/// hydrogen within 1.6 Angstrom of another hydrogen or an oxygen (2.3 of other atoms), the best of 24 rotations is
/// taken, but for imines. Where an atom of another residue is bound, the first hydrogen is put towards it.
/// @param n_given      the first atoms keep their places, the others are hydrogens, whose places are not looked at
/// @param surroundings may contain the ligand's own atoms; its hydrogens are not looked at
/// @returns [atom - n_given] Angstrom; the same bits for the same input, and turned with it, but for a single heavy
/// atom
std::vector<Vec3d> place_hydrogens(const Mol2File& ligand, const std::vector<Mol2Bond>& bonds, std::size_t n_given,
                                   const Molecule& surroundings);

}  // namespace espdiff
