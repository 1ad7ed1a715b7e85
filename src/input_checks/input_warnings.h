// input_warnings.h: what is wrong with the two molecules as a pair, before any surface is made.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

/// Looks for inputs that cannot be compared, or that differ in more than their state:
/// - residues that follow each other farther apart than a chain can stretch, as in molecules cut by a periodic cell,
///   unless both molecules have the gap;
/// - paired residues of opposite chirality, as in mirror images;
/// - residues that lie on the place of another residue, all shifted alike along the chain, or a stretch of eight;
/// - side chains that lie in each other's places;
/// - an RMSD so large that the superposition means nothing (relative to the radii of gyration);
/// - chains that fit by themselves but are arranged differently;
/// - ligands that moved or turned, and equal chains that pair by their arrangement against their names;
/// - charges and coordinates that cannot be right, and charges of two force fields;
/// - hydrogens, or other radii, on one side only.
/// Time is linear in the number of atoms, but for logarithms.
/// @param alignment with domains and the chains' motions
std::vector<Warning> input_warnings(const Molecule& source, const Molecule& target, const Alignment& alignment);

}  // namespace espdiff
