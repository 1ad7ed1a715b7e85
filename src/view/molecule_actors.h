// molecule_actors.h: a molecule under or beside its surface, in one of the usual drawings.
#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

#include "base/types.h"
#include "view/scene.h"

namespace espdiff {

/// Pairs of atoms within the sum of their covalent radii and 0.4 A; each atom of no element counts as carbon. Hydrogens
/// are bound to the nearest other atom only. Cells of 3 A: linear in the number of atoms.
std::vector<std::array<int, 2>> find_bonds(const Molecule& molecule);

/// The atoms of some residues. Radii and charges are left out.
Molecule with_residues(const Molecule& molecule, const std::vector<bool>& is_kept);

/// Residues of ligands, ions and water, as far as an atom of theirs is within a distance of the polymer's: those
/// without a backbone, in molecules that have one. [residue]
std::vector<bool> residues_around(const Molecule& molecule, double distance_A);
/// Residues that are part of a polymer: with a backbone, or of nucleic acids. [residue]
std::vector<bool> polymer_residues(const Molecule& molecule);

/// What draws a molecule in a style; sticks are balls and sticks, elements in Jmol's colours. nullptr for kNone or
/// where there is nothing to draw.
/// @param width of lines, pixels
vtkSmartPointer<vtkProp> make_molecule_actor(const Molecule& molecule, MoleculeStyle style, double width);

}  // namespace espdiff
