// molecule_actors.h: draws a molecule under or beside its surface in a standard style.
#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

#include "base/types.h"
#include "scene/scene.h"

namespace espdiff {

/// Pairs of atoms within the sum of their covalent radii plus 0.4 A; an atom without element counts as carbon.
/// Hydrogens bond only to the nearest other atom. Cells of 3 A: linear in the number of atoms.
std::vector<std::array<int, 2>> find_bonds(const Molecule& molecule);

/// The atoms of some residues, without radii and charges.
Molecule with_residues(const Molecule& molecule, const std::vector<bool>& is_kept);

/// [residue] ligands, ions and water with an atom within a distance of the polymer: residues without a backbone, in
/// molecules that have one.
std::vector<bool> residues_around(const Molecule& molecule, double distance_A);
/// [residue] whether it is part of a polymer: with a backbone, or of a nucleic acid.
std::vector<bool> polymer_residues(const Molecule& molecule);

/// The drawing of a molecule in a style; sticks are balls and sticks, with elements in Jmol's colours. nullptr for
/// kNone or if there is nothing to draw.
/// @param width of lines, pixels
vtkSmartPointer<vtkProp> make_molecule_actor(const Molecule& molecule, MoleculeStyle style, double width);

}  // namespace espdiff
